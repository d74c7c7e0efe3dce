// Tables as runs of bodies.
#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/median.hpp"
#include "bodies/law.hpp"
#include "io/bodies_file.hpp"
#include "io/table.hpp"

namespace lilytank {
namespace {

int column(const Table& table, const NamedAt& wanted) {
  if (wanted.name.empty()) return -1;
  const int found = table.find(wanted.name);
  if (found >= 0) return found;
  std::string list;
  for (const std::string& known : table.names()) list += (list.empty() ? "" : ", ") + known;
  throw InputError(wanted.place, table.file() + " has no column '" + wanted.name + "'" +
                                     did_you_mean(wanted.name, table.names()) + "; it has " + list);
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

// The rows of a run as they come.
struct Rows {
  std::string name;
  std::vector<std::string> bodies;
  std::vector<double> time, drivers;
  std::vector<std::vector<double>> cells;
  std::vector<int> lines;  // of each body's row at the last time; 0: it has none yet
};

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));  // empty cells say the same
}

class TableReader {
 public:
  TableReader(const BodyTable& t, const BodyExperiment& e)
      : t_(&t), e_(&e), lines_(t.file), table_(lines_) {
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

  // What is too short is told in `left_out`.
  std::vector<BodyRun> read(std::vector<std::string>& left_out) {
    while (table_.next()) row();
    std::vector<BodyRun> out;
    for (const std::string& key : order_) finish(runs_.at(key), out, left_out);
    if (out.empty()) throw InputError({t_->file, 1, 1}, "no run has eight rows or more");
    return out;
  }

 private:
  void row() {
    std::string name, body;
    if (body_ >= 0) name = body = std::string(table_.cell(body_));
    if (run_ >= 0) name += (name.empty() ? "" : " ") + std::string(table_.cell(run_));
    if (t_->together && run_ >= 0) name = std::string(table_.cell(run_));
    if (t_->together && run_ < 0) name = "";
    auto [found, fresh] = runs_.try_emplace(name);
    Rows& r = found->second;
    if (fresh) order_.push_back(name), r.name = name;
    const double time = table_.number(time_);
    if (std::isnan(time)) table_.refuse(time_, table_.quoted(time_) + " is not a time");
    if (!r.time.empty() && time < r.time.back()) {
      table_.refuse(time_, table_.quoted(time_) + " is before the row above");
    }
    if (r.time.empty() || time > r.time.back()) {
      const std::vector<double> drivers = driver_cells();
      r.time.push_back(time), r.cells.emplace_back();
      r.drivers.insert(r.drivers.end(), drivers.begin(), drivers.end());
      r.lines.assign(r.bodies.size(), 0);
    }
    put(r, body);
  }

  std::vector<double> driver_cells() const {
    std::vector<double> out;
    for (const int d : drivers_) {
      out.push_back(table_.number(d));
      if (std::isnan(out.back())) table_.refuse(d, table_.quoted(d) + " is not a number");
    }
    return out;
  }

  // A row of one body, or of all of them.
  void put(Rows& r, const std::string& body) {
    std::vector<double>& to = r.cells.back();
    const std::size_t b = number_of(body, r);
    const std::vector<double> here = cells();
    const std::size_t at = b * static_cast<std::size_t>(e_->dimensions);
    to.resize(std::max(to.size(), at + here.size()), NAN);
    const auto before = to.begin() + static_cast<std::ptrdiff_t>(at);
    if (r.lines[b] != 0) {
      // A row that a tracker wrote twice says nothing new.
      if (!std::equal(here.begin(), here.end(), before, same) || !same_drivers(r)) {
        refuse_second(r.lines[b]);
      }
      return;
    }
    r.lines[b] = table_.line();
    std::copy(here.begin(), here.end(), before);
  }

  bool wide() const { return t_->x.size() > 1; }

  // Bodies together share the drivers of the first of them, so those of others are not looked at.
  bool same_drivers(const Rows& r) const {
    if (t_->together && !wide()) return true;
    const std::vector<double> here = driver_cells();
    return std::equal(here.rbegin(), here.rend(), r.drivers.rbegin());
  }

  // The place of a row's body among those of its run; of wide tables, that of the first.
  std::size_t number_of(const std::string& body, Rows& r) const {
    if (wide()) {
      if (r.bodies.empty()) {
        for (const NamedAt& x : t_->x) r.bodies.push_back(x.name);
        r.lines.assign(r.bodies.size(), 0);
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
    r.bodies.push_back(body), r.lines.push_back(0);
    return r.bodies.size() - 1;
  }

  // Two rows of one body, run and time that say different things: one of them would be lost.
  [[noreturn]] void refuse_second(int first) const {
    std::string missing;
    if (body_ < 0 && !wide()) missing = "recording.body";
    if (run_ < 0) missing += (missing.empty() ? "" : " or ") + std::string("recording.run");
    table_.refuse(time_, table_.quoted(time_) + " is that of line " + std::to_string(first) +
                             " too, with other values" +
                             (missing.empty() ? "" : ": is there no column for " + missing + "?"));
  }

  // Leaves one row in `every`.
  void thin(Rows& r) const {
    const auto every = static_cast<std::size_t>(t_->every);
    if (every == 1) return;
    const std::size_t drivers = drivers_.size();
    std::size_t to = 0;
    for (std::size_t from = 0; from < r.time.size(); from += every, ++to) {
      r.time[to] = r.time[from], r.cells[to] = r.cells[from];
      for (std::size_t d = 0; d < drivers; ++d) {
        r.drivers[to * drivers + d] = r.drivers[from * drivers + d];
      }
    }
    r.time.resize(to), r.cells.resize(to), r.drivers.resize(to * drivers);
  }

  // Cuts a run where it was not recorded for long.
  void finish(Rows& r, std::vector<BodyRun>& out, std::vector<std::string>& left_out) const {
    constexpr double kLongest = 8;  // of the usual step
    constexpr std::size_t kLeast = 8;
    const auto too_short = [&](std::size_t piece, std::size_t rows) {
      left_out.push_back(name_of(r, piece) + ": " + std::to_string(rows) +
                         (rows == 1 ? " row" : " rows") + " where eight are needed: left out");
    };
    thin(r);
    const std::size_t row = r.bodies.size() * static_cast<std::size_t>(e_->dimensions);
    const std::size_t n = r.time.size(), drivers = drivers_.size();
    std::vector<double> steps;
    for (std::size_t k = 1; k < n; ++k) steps.push_back(r.time[k] - r.time[k - 1]);
    if (n < kLeast) return too_short(1, n);
    const double usual = median(std::move(steps));
    for (std::size_t from = 0, k = 1, piece = 1; k <= n; ++k) {
      if (k < n && r.time[k] - r.time[k - 1] <= kLongest * usual) continue;
      if (k - from < kLeast) {
        too_short(piece++, k - from);
      } else {
        BodyRun run = empty_run(r, piece++);
        for (std::size_t i = from; i < k; ++i) {
          run.time.push_back(r.time[i] - r.time[from]);
          r.cells[i].resize(row, NAN);
          run.position.insert(run.position.end(), r.cells[i].begin(), r.cells[i].end());
          for (std::size_t d = 0; d < drivers; ++d)
            run.drivers.push_back(r.drivers[i * drivers + d]);
        }
        out.push_back(std::move(run));
      }
      from = k;
    }
  }

  std::string name_of(const Rows& r, std::size_t piece) const {
    const std::string name =
        r.name.empty() ? t_->file.substr(t_->file.find_last_of('/') + 1) : r.name;
    return piece > 1 ? name + " part " + std::to_string(piece) : name;
  }

  BodyRun empty_run(const Rows& r, std::size_t piece) const {
    BodyRun run;
    run.name = name_of(r, piece);
    run.bodies = r.bodies, run.held_out = t_->held_out;
    for (std::size_t b = 0; b < r.bodies.size(); ++b) {
      run.mass.push_back(of_body(t_->mass, b, r.bodies[b], 1, "mass"));
      run.radius.push_back(of_body(t_->radius, b, r.bodies[b], 0, "radius"));
    }
    return run;
  }

  std::vector<double> cells() const {
    std::vector<double> out;
    for (const int c : places_) {
      const double value = table_.number(c) * t_->scale;
      if (std::fabs(value) > 1e12) table_.refuse(c, table_.quoted(c) + " is too large");
      out.push_back(value);
    }
    return out;
  }

  const BodyTable* t_;
  const BodyExperiment* e_;
  LineSource lines_;
  Table table_;
  int time_ = -1, body_ = -1, run_ = -1;
  std::vector<int> places_, drivers_;
  std::map<std::string, Rows> runs_;
  std::vector<std::string> order_;
};

void find_latitude(const NamedAt& latitude, BodyExperiment& e) {
  if (latitude.name.empty()) return;
  const auto found = std::find(e.drivers.begin(), e.drivers.end(), latitude.name);
  if (found == e.drivers.end()) {
    throw InputError(latitude.place, "experiment.latitude = \"" + latitude.name +
                                         "\" is none of the drivers of the recordings" +
                                         did_you_mean(latitude.name, e.drivers));
  }
  e.latitude = static_cast<int>(found - e.drivers.begin());
}

}  // namespace

BodyExperiment load_body_experiment(const std::string& file) {
  std::vector<std::string> laws;
  for (const bodies::Law* law : bodies::law_library()) {
    if (!law->curve()) laws.emplace_back(law->name());
  }
  const BodyFile read = read_body_file(file, laws);
  BodyExperiment e = read.experiment;
  for (const BodyTable& t : read.tables) {
    std::vector<std::string> drivers;
    for (const NamedAt& d : t.drivers) drivers.push_back(d.name);
    if (&t == &read.tables.front()) e.drivers = drivers;
    if (drivers != e.drivers) {
      throw InputError(t.place, "this recording's drivers are not those of the first one");
    }
    e.masses = e.masses || t.mass.given();
    for (BodyRun& run : TableReader(t, e).read(e.left_out)) e.runs.push_back(std::move(run));
  }
  for (const BodyTable& t : read.tables) {
    if (e.masses && !t.mass.given()) {
      throw InputError(t.place, "recording.mass is missing, and other recordings have it");
    }
  }
  find_latitude(read.latitude, e);
  return e;
}

}  // namespace lilytank
