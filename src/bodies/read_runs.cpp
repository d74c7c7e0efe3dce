// Tables as runs of bodies.
#include <algorithm>
#include <cmath>
#include <map>

#include "bodies/bodies_file.hpp"
#include "bodies/geographic.hpp"
#include "bodies/law.hpp"
#include "io/table.hpp"
#include "io/time_text.hpp"
#include "statistics/median.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

int column(const Table& table, const NamedAt& wanted) {
  if (wanted.name.empty()) return -1;
  const int found = table.find(wanted.name);
  if (found >= 0) return found;
  throw InputError(wanted.place, table.file() + " has no column '" + wanted.name + "'" +
                                     did_you_mean(wanted.name, table.names()) + "; it has " +
                                     joined(table.names(), ", "));
}

double of_body(const BodyFigures& numbers, std::size_t index, const std::string& body,
               double standard, const std::string& what) {
  if (!numbers.by_name.empty()) {
    const auto found = numbers.by_name.find(body);
    if (found != numbers.by_name.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [name, value] : numbers.by_name) names.push_back(name);
    throw InputError(numbers.place,
                     "recording." + what + " has no '" + body + "'" + did_you_mean(body, names));
  }
  if (numbers.values.empty()) return standard;
  return numbers.values.size() == 1 ? numbers.values[0] : numbers.values[index];
}

/// A row of the table.
struct Row {
  double time = 0;
  int line = 0;
  std::size_t body = 0;   ///< index into Rows::bodies
  std::size_t cells = 0;  ///< index into Rows::values, of its positions and then its drivers
};

/// The rows of a run, and their values at every time.
struct Rows {
  std::string name;
  std::vector<std::string> bodies;
  std::vector<Row> rows;
  std::vector<double> values;

  std::vector<double> time, drivers;
  std::vector<std::vector<double>> cells;
  std::vector<int> lines;  // of each body's row at the last time; 0: it has none yet
};

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));  // empty cells say the same
}

/// Whether a name comes before another one; numbers by their size.
bool name_before(const std::string& a, const std::string& b) {
  const auto one = parse_number(a), other = parse_number(b);
  if (one && other && *one != *other) return *one < *other;
  if (one.has_value() != other.has_value()) return one.has_value();
  return a < b;
}

class TableReader {
 public:
  TableReader(const BodyTable& t, const BodyExperiment& e)
      : t_(&t), e_(&e), lines_(t.file), table_(lines_, t.layout) {
    time_ = column(table_, t.time), body_ = column(table_, t.body), run_ = column(table_, t.run);
    for (std::size_t i = 0; i < t.x.size(); ++i) {
      places_.push_back(column(table_, t.x[i]));
      if (e.dimensions == 2) places_.push_back(column(table_, t.y[i]));
    }
    for (const NamedAt& d : t.drivers) drivers_.push_back(column(table_, d));
    for (const auto* n : {&t.mass, &t.radius}) {
      if (n->values.size() > 1 && n->values.size() != t.x.size()) {
        throw InputError(n->place, std::to_string(n->values.size()) + " values for " +
                                       std::to_string(t.x.size()) + " columns of positions");
      }
    }
  }

  // Rows that are left out are counted in `left_out`.
  std::vector<BodyRun> read(std::vector<std::string>& left_out) {
    while (table_.next()) take_row();
    count(nameless_, "row",
          std::string(" without a ") + (body_ >= 0 ? "body" : "run") + " left out", left_out);
    count(table_.comment_lines(), "comment line", " passed over", left_out);
    if (!ordered_) std::sort(order_.begin(), order_.end(), name_before);
    std::vector<BodyRun> out;
    for (const std::string& key : order_) {
      Rows& r = runs_.at(key);
      if (!ordered_) sort(r);
      for (const Row& row : r.rows) put(r, row);
      finish(r, out, left_out);
    }
    if (out.empty()) throw InputError({t_->file, 1, 1}, "no run has eight rows or more");
    return out;
  }

 private:
  static constexpr std::int64_t kMostRows = 10'000'000;  // of about 200 bytes

  void take_row() {
    if ((body_ >= 0 && table_.not_seen(body_)) || (run_ >= 0 && table_.not_seen(run_))) {
      ++nameless_;
      return;
    }
    if (++rows_ > kMostRows) {
      throw InputError({table_.file(), table_.line(), 0},
                       "more than " + std::to_string(kMostRows) + " rows: thin the table");
    }
    std::string name, body;
    if (body_ >= 0) name = body = std::string(table_.cell(body_));
    if (run_ >= 0) name += (name.empty() ? "" : " ") + std::string(table_.cell(run_));
    if (t_->together && run_ >= 0) name = std::string(table_.cell(run_));
    if (t_->together && run_ < 0) name = "";
    auto [found, fresh] = runs_.try_emplace(name);
    Rows& r = found->second;
    if (fresh) order_.push_back(name), r.name = name;
    const double time = time_of(table_, time_, times_, t_->time_unit);
    if (!r.rows.empty() && time < r.rows.back().time) ordered_ = false;
    r.rows.push_back({time, table_.line(), number_of(body, r), r.values.size()});
    for (std::size_t k = 0; k < places_.size(); ++k) {
      r.values.push_back(e_->geographic ? degrees(places_[k], k % 2 == 1) : position(places_[k]));
    }
    for (const int d : drivers_) r.values.push_back(table_.finite(d));
  }

  double position(int column) const {
    const double value = table_.number(column) * t_->scale;
    if (std::fabs(value) > 1e12) table_.refuse(column, table_.quoted(column) + " is too large");
    return value;
  }

  // NaN where there is none.
  double degrees(int column, bool latitude) const {
    const double value = table_.number(column), most = latitude ? 90 : 360;
    if (std::fabs(value) > most) {
      table_.refuse(column, table_.quoted(column) + " is no " +
                                (latitude ? "latitude" : "longitude") + " in degrees");
    }
    return value;
  }

  void count(std::int64_t lines, const std::string& noun, const std::string& done,
             std::vector<std::string>& left_out) const {
    if (lines == 0) return;
    left_out.push_back(short_file() + ": " + counted(lines, noun) + done);
  }

  // By time, so that rows may stand in any order; bodies by name, so that it makes no difference.
  void sort(Rows& r) const {
    std::stable_sort(r.rows.begin(), r.rows.end(),
                     [](const Row& a, const Row& b) { return a.time < b.time; });
    if (wide()) return;
    const std::vector<std::string> before = r.bodies;
    std::sort(r.bodies.begin(), r.bodies.end(), name_before);
    std::vector<std::size_t> now;
    for (const std::string& body : before) {
      const auto at = std::find(r.bodies.begin(), r.bodies.end(), body);
      now.push_back(static_cast<std::size_t>(at - r.bodies.begin()));
    }
    for (Row& row : r.rows) row.body = now[row.body];
  }

  // A row of one body, or of all of them.
  void put(Rows& r, const Row& row) const {
    const auto here = r.values.begin() + static_cast<std::ptrdiff_t>(row.cells);
    const auto end = here + static_cast<std::ptrdiff_t>(places_.size());
    const auto drivers_end = end + static_cast<std::ptrdiff_t>(drivers_.size());
    if (r.time.empty() || row.time > r.time.back()) {
      r.time.push_back(row.time), r.cells.emplace_back();
      r.drivers.insert(r.drivers.end(), end, drivers_end);
      r.lines.assign(r.bodies.size(), 0);
    }
    std::vector<double>& to = r.cells.back();
    const std::size_t at = row.body * static_cast<std::size_t>(e_->dimensions);
    to.resize(std::max(to.size(), at + places_.size()), NAN);
    const auto before = to.begin() + static_cast<std::ptrdiff_t>(at);
    if (r.lines[row.body] == 0) {
      r.lines[row.body] = row.line;
      std::copy(here, end, before);
      return;
    }
    // A row that a tracker wrote twice is ignored. Bodies together share the drivers of the
    // first of them, so those of others are not compared.
    const auto drivers_here = r.drivers.end() - static_cast<std::ptrdiff_t>(drivers_.size());
    const bool shared = t_->together && !wide();
    if (std::equal(here, end, before, same) &&
        (shared || std::equal(end, drivers_end, drivers_here))) {
      return;
    }
    refuse_second(r.lines[row.body], row.line);
  }

  bool wide() const { return t_->x.size() > 1; }

  // The place of a row's body among those of its run; of wide tables, that of the first.
  std::size_t number_of(const std::string& body, Rows& r) const {
    if (wide()) {
      if (r.bodies.empty()) {
        for (const NamedAt& x : t_->x) r.bodies.push_back(x.name);
      }
      return 0;
    }
    const auto at = std::find(r.bodies.begin(), r.bodies.end(), body);
    if (at != r.bodies.end()) return static_cast<std::size_t>(at - r.bodies.begin());
    const std::size_t most = most_together(e_->dimensions);
    if (r.bodies.size() == most) {
      table_.refuse(body_ >= 0 ? body_ : time_,
                    "more than " + std::to_string(most) + " bodies together");
    }
    r.bodies.push_back(body);
    return r.bodies.size() - 1;
  }

  // Refuses two different rows of one body, run and time.
  [[noreturn]] void refuse_second(int first, int second) const {
    std::string missing;
    if (body_ < 0 && !wide()) missing = "recording.body";
    if (run_ < 0) missing += (missing.empty() ? "" : " or ") + std::string("recording.run");
    LineSource lines(t_->file);
    Table table(lines, t_->layout);
    while (table.next() && table.line() < second) {
    }
    table.refuse(time_, table.quoted(time_) + " is that of line " + std::to_string(first) +
                            " too, with other values" +
                            (missing.empty() ? "" : ": is there no column for " + missing + "?"));
  }

  // Takes one row in `every`, and cuts a run where it was not recorded for long.
  void finish(Rows& r, std::vector<BodyRun>& out, std::vector<std::string>& left_out) const {
    constexpr double kLongest = 8;  // of the usual step
    constexpr std::size_t kLeast = 8;
    const auto too_short = [&](std::size_t piece, std::size_t rows) {
      left_out.push_back(name_of(r, piece) + ": " +
                         counted(static_cast<std::int64_t>(rows), "row") +
                         " where eight are needed: left out");
    };
    const std::size_t row = r.bodies.size() * static_cast<std::size_t>(e_->dimensions);
    const std::size_t drivers = drivers_.size(), every = static_cast<std::size_t>(t_->every);
    const std::size_t n = (r.time.size() + every - 1) / every;
    const auto time = [&](std::size_t k) { return r.time[k * every]; };
    std::vector<double> steps;
    for (std::size_t k = 1; k < n; ++k) steps.push_back(time(k) - time(k - 1));
    if (n < kLeast) return too_short(1, n);
    const double usual = median(std::move(steps));
    for (std::size_t from = 0, k = 1, piece = 1; k <= n; ++k) {
      if (k < n && time(k) - time(k - 1) <= kLongest * usual) continue;
      if (k - from < kLeast) {
        too_short(piece++, k - from);
      } else {
        BodyRun run = empty_run(r, piece++);
        for (std::size_t i = from; i < k; ++i) {
          std::vector<double>& cells = r.cells[i * every];
          const auto of = r.drivers.begin() + static_cast<std::ptrdiff_t>(i * every * drivers);
          run.time.push_back(time(i) - time(from));
          cells.resize(row, NAN);
          run.position.insert(run.position.end(), cells.begin(), cells.end());
          run.drivers.insert(run.drivers.end(), of, of + static_cast<std::ptrdiff_t>(drivers));
        }
        out.push_back(std::move(run));
      }
      from = k;
    }
  }

  std::string short_file() const { return t_->file.substr(t_->file.find_last_of('/') + 1); }

  std::string name_of(const Rows& r, std::size_t piece) const {
    const std::string name = r.name.empty() ? short_file() : r.name;
    return piece > 1 ? name + " part " + std::to_string(piece) : name;
  }

  BodyRun empty_run(const Rows& r, std::size_t piece) const {
    BodyRun run;
    run.name = name_of(r, piece), run.part_of = piece > 1 ? name_of(r, 1) : "";
    run.bodies = r.bodies, run.held_out = t_->held_out;
    for (std::size_t b = 0; b < r.bodies.size(); ++b) {
      run.mass.push_back(of_body(t_->mass, b, r.bodies[b], 1, "mass"));
      run.radius.push_back(of_body(t_->radius, b, r.bodies[b], 0, "radius"));
    }
    return run;
  }

  const BodyTable* t_;
  const BodyExperiment* e_;
  LineSource lines_;
  Table table_;
  int time_ = -1, body_ = -1, run_ = -1;
  std::vector<int> places_, drivers_;
  std::map<std::string, Rows> runs_;
  std::vector<std::string> order_;
  TimeText times_;
  bool ordered_ = true;  ///< times do not fall in any run
  std::int64_t rows_ = 0, nameless_ = 0;
};

int driver_of(const std::string& key, const NamedAt& named, const BodyExperiment& e) {
  const auto found = std::find(e.drivers.begin(), e.drivers.end(), named.name);
  if (found == e.drivers.end()) {
    throw InputError(named.place, "experiment." + key + " = \"" + named.name +
                                      "\" is none of the drivers of the recordings" +
                                      did_you_mean(named.name, e.drivers));
  }
  return static_cast<int>(found - e.drivers.begin());
}

}  // namespace

std::vector<std::string> baseline_laws() {
  std::vector<std::string> out;
  for (const bodies::Law& law : bodies::law_library()) {
    if (!law.curve) out.emplace_back(law.name);
  }
  return out;
}

BodyExperiment load_body_experiment(const std::string& file) {
  const BodyFile read = read_body_file(file, baseline_laws());
  BodyExperiment e = read.experiment;
  for (const BodyTable& t : read.tables) {
    std::vector<std::string> drivers;
    for (const NamedAt& d : t.drivers) drivers.push_back(d.name);
    if (&t == &read.tables.front()) e.drivers = drivers;
    if (drivers != e.drivers) {
      throw InputError(t.place, "this recording's drivers are not those of the first one");
    }
    e.masses = e.masses || t.mass.given();
    e.files.push_back(t.file);
    for (BodyRun& run :
         with_enough_memory(t.file, [&] { return TableReader(t, e).read(e.left_out); })) {
      e.runs.push_back(std::move(run));
    }
  }
  for (const BodyTable& t : read.tables) {
    if (e.masses && !t.mass.given()) {
      throw InputError(t.place, "recording.mass is missing, and other recordings have it");
    }
  }
  if (e.geographic) {
    if (read.latitude.name.empty()) add_latitudes(e);
    project_positions(file, e);
  }
  if (!read.latitude.name.empty()) e.latitude = driver_of("latitude", read.latitude, e);
  for (std::size_t d = 0; d < read.current.size(); ++d)
    e.current[d] = driver_of("current", read.current[d], e);
  for (std::size_t d = 0; d < read.wind.size(); ++d) e.wind[d] = driver_of("wind", read.wind[d], e);
  return e;
}

}  // namespace lilytank
