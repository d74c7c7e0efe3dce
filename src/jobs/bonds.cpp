#include "jobs/bonds.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "assemblies/pattern.hpp"
#include "lilytank/statistics.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

using Cells = std::vector<Cell>;

/// Whether the cells can be laid on some of the target's, turned but not mirrored.
bool part_of(Cells shape, const Cells& target) {
  if (shape.size() > target.size()) return false;
  const auto in_target = [&](const Cell& cell) {
    return std::find(target.begin(), target.end(), cell) != target.end();
  };
  for (int turn = 0; turn < 4; ++turn) {
    for (const Cell& at : target) {
      const int dx = at.x - shape[0].x, dy = at.y - shape[0].y;
      if (std::all_of(shape.begin(), shape.end(), [&](const Cell& c) {
            return in_target({c.x + dx, c.y + dy});
          })) {
        return true;
      }
    }
    for (Cell& cell : shape) cell = {-cell.y, cell.x};
  }
  return false;
}

/// Follows which faces hold each other.
class Replay {
 public:
  Replay(const Model& model, std::vector<StoredBond>& bonds) : model_(&model), bonds_(&bonds) {
    std::set<Cells> targets;
    for (const Ruleset& rules : model.rulesets) targets.insert(canonical_shape(rules.target));
    if (targets.size() == 1) target_ = *targets.begin();
  }

  void take(const StoredEvent& e) {
    const std::string kind = event_words()[static_cast<std::size_t>(e.kind)];
    if (kind == "latch") {
      open_[{e.a, e.face_a}] = bonds_->size(), open_[{e.b, e.face_b}] = bonds_->size();
      StoredBond& bond = bonds_->emplace_back();
      bond.a = e.a, bond.b = e.b, bond.face_a = e.face_a, bond.face_b = e.face_b;
      bond.latched = e.time;
      if (model_->rulesets.empty()) join(bond, e);
      return;
    }
    if (kind != "link" && kind != "unlink" && kind != "unlatch") return;
    const auto found = open_.find({e.a, e.face_a});
    if (found == open_.end()) return;
    StoredBond& bond = (*bonds_)[found->second];
    if (kind == "link") return join(bond, e);
    bond.released = e.time, bond.end = kind == "unlink" ? e.rule : kind;
    open_.erase(found), open_.erase({e.b, e.face_b});
  }

 private:
  void join(StoredBond& bond, const StoredEvent& e) {
    bond.joined = e.time, bond.rule = e.rule;
    const Cells cells = assembly_of(bond.a);
    bond.size = static_cast<int>(cells.size());
    if (!target_.empty()) bond.right = part_of(cells, target_) ? 1 : 0;
  }

  /// Cells of all modules that joins connect with one; a module's faces and its turn place its
  /// neighbours.
  Cells assembly_of(int module) const {
    struct Placed {
      Cell cell;
      int turn = 0;
    };
    std::map<int, Placed> placed{{module, {}}};
    std::vector<int> todo{module};
    while (!todo.empty()) {
      const int at = todo.back();
      const Placed from = placed[at];
      todo.pop_back();
      for (int face = 0; face < 4; ++face) {
        const auto found = open_.find({at, face});
        if (found == open_.end()) continue;
        const StoredBond& bond = (*bonds_)[found->second];
        if (bond.joined < 0) continue;
        const bool first = bond.a == at && bond.face_a == face;
        const int other = first ? bond.b : bond.a, theirs = first ? bond.face_b : bond.face_a;
        const int direction = (face + from.turn) & 3;
        const Placed next{neighbour(from.cell, direction), (direction + 2 - theirs) & 3};
        if (placed.try_emplace(other, next).second) todo.push_back(other);
      }
    }
    Cells out;
    for (const auto& [body, place] : placed) out.push_back(place.cell);
    return out;
  }

  const Model* model_;
  std::vector<StoredBond>* bonds_;
  Cells target_;
  std::map<std::pair<int, int>, std::size_t> open_;  // of module and face
};

std::string time_cell(double time) {
  return time < 0 ? "" : without_rounding(time);
}

/// "41 s [30, 55]", or "-" where fewer than half of the bonds ended.
std::string median_of(const std::vector<Duration>& lives) {
  const Survival curve = kaplan_meier(lives);
  const auto first_below = [&](const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] <= 0.5) return significant(curve.time[i], 3);
    }
    return std::string("-");
  };
  const std::string median = first_below(curve.survival);
  if (median == "-") return median;
  return median + " s [" + first_below(curve.low) + ", " + first_below(curve.high) + "]";
}

}  // namespace

std::vector<StoredBond> bonds_of(const std::vector<StoredEvent>& events, const Model& model) {
  std::vector<StoredBond> out;
  Replay replay(model, out);
  for (const StoredEvent& event : events) replay.take(event);
  return out;
}

std::string bonds_table(const std::vector<StoredBond>& bonds) {
  std::string out = "latched,joined,released,module_a,face_a,module_b,face_b,rule,end,size,right\n";
  for (const StoredBond& b : bonds) {
    out += time_cell(b.latched) + "," + time_cell(b.joined) + "," + time_cell(b.released);
    for (const int number : {b.a, b.face_a, b.b, b.face_b}) out += "," + std::to_string(number);
    out += "," + b.rule + "," + b.end + "," + (b.size > 0 ? std::to_string(b.size) : "") + "," +
           (b.right < 0 ? "" : std::to_string(b.right)) + "\n";
  }
  return out;
}

ReportSection bonds_section(const std::vector<StoredBond>& bonds, double end) {
  ReportSection section;
  section.title = "Bonds";
  section.table.head = {"connection", "number", "released", "median lifetime"};
  const auto add = [&](const std::string& name, auto&& counts) {
    std::vector<Duration> lives;
    int number = 0, released = 0;
    for (const StoredBond& bond : bonds) {
      if (!counts(bond)) continue;
      const double from = bond.joined < 0 ? bond.latched : bond.joined;
      const bool ended = bond.released >= 0;
      lives.push_back({(ended ? bond.released : end) - from, ended});
      ++number, released += ended ? 1 : 0;
    }
    if (number == 0) return;
    section.table.rows.push_back(
        {name, std::to_string(number), std::to_string(released), median_of(lives)});
  };
  add("latches that were never joined", [](const StoredBond& b) { return b.joined < 0; });
  add("joins to a part of the target", [](const StoredBond& b) { return b.right == 1; });
  add("joins to another shape", [](const StoredBond& b) { return b.right == 0; });
  add("joins", [](const StoredBond& b) { return b.joined >= 0 && b.right < 0; });
  if (!section.table.rows.empty()) {
    section.below.push_back(
        "A lifetime runs from the join (of latches: from the latch) to the release; the median is "
        "Kaplan and Meier's, with its 95 % interval, and - where fewer than half have ended.");
  }
  return section;
}

}  // namespace lilytank
