// Which flow a run's pumps made when: the base station sets their power by time and by copies.
#pragma once
#include <string>
#include <vector>

#include "lilytank/run.hpp"

namespace lilytank {

/// The flows of a model by number: 0 is Model::field, i is Model::other_fields[i - 1]. May be null.
const FlowField* field_of(const Model& model, int number);
/// The highest mean speed of any of them inside the tank (m/s, before K_v); 0: still water.
double peak_of_all(const Model& model);

/// The flow in force over the time of a stored run. Commands by time count from their own time;
/// those by finished copies from the stored frame with labels of so many.
class Pumps {
 public:
  explicit Pumps(const StoredRun& run);
  /// Number of the flow in force at a time (s).
  int field_at(double time) const;
  /// "80 %", the power that makes a flow; empty where the pumps are never set, or it is not known.
  std::string power_of(int field) const;

  struct Since {
    double time = 0;  ///< s
    int field = 0;    ///< number of the flow in force from then on
  };
  /// All changes by time; the first one holds from the start.
  const std::vector<Since>& changes() const { return changes_; }

 private:
  std::vector<Since> changes_;
  std::vector<std::string> powers_;  // by number of the flow
};

}  // namespace lilytank
