// Statistics of single connections of a run: how each began, what it joined, how it ended.
#pragma once
#include <string>
#include <vector>

#include "lilytank/model.hpp"
#include "lilytank/report.hpp"
#include "lilytank/run_events.hpp"

namespace lilytank {

/// Two modules that held each other, from the latch to the release. A *join* is the moment when a
/// link rule makes the latch a bond or, in a model without rulesets, the latch itself.
struct StoredBond {
  int a = -1, b = -1;            ///< modules
  int face_a = -1, face_b = -1;  ///< their connectors
  double latched = 0;            ///< s
  double joined = -1;            ///< s; -1: never
  double released = -1;          ///< s; -1: holds at the end of the run
  std::string rule;              ///< that joined; empty: none
  std::string end;  ///< rule that released a bond, or "unlatch" of a latch; empty: holds
  int size = 0;     ///< modules of the assembly that the join made; 0: never joined
  /// 1: the assembly that the join made is a part of the target, or all of it, up to turning; 0: it
  /// is not; -1: never joined, or the model has no target, or rulesets with several.
  int right = -1;
};

/// The connections of a run in the order of their latches, from its events.
std::vector<StoredBond> bonds_of(const std::vector<StoredEvent>& events, const Model& model);

/// bonds.csv: a row a connection; empty cells for -1.
std::string bonds_table(const std::vector<StoredBond>& bonds);

/// Latches, joins by whether they are right, how long their bonds last (Kaplan and Meier: bonds
/// that hold at `end` s are censored). Without rows if nothing latched.
ReportSection bonds_section(const std::vector<StoredBond>& bonds, double end);

}  // namespace lilytank
