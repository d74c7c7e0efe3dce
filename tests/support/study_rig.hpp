// Study files over tiny scenarios.
#pragma once
#include <string>

#include "lilytank/study.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank::test {

inline const std::string kPairRulesText =
    "lilytank ruleset 1\nname pair\nhops counter-clockwise\ntarget\n  ##\nend\n"
    "join: (0,0) (0,0) -> (1,1)-(2,1)  p=1\npart: (1,1)-(2,1) -> (0,0) (0,0)  p=0.5\n";

/// Six modules in a small tank, pairs that come and go, a few seconds.
inline const std::string kPairScenario =
    "title = \"pair\"\n[run]\nduration = 8\n[tank]\nradius = 0.16\n[module]\ncount = 6\n"
    "[start]\nradius = 0.12\n[ruleset]\nfile = \"pair.rules\"\n";

/// A directory with pair.toml, its ruleset and overlays, to read studies in.
class StudyRig {
 public:
  StudyRig() {
    here.write("pair.rules", kPairRulesText);
    here.write("pair.toml", kPairScenario);
    here.write("sticky.toml", "[rules]\npart.p = 0\n");
    here.write("loose.toml", "[rules]\npart.p = 1\n");
  }

  Study study(const std::string& text, const std::vector<std::string>& sets = {}) const {
    return Study(here.write("study.toml", text), sets);
  }
  /// Why a study file is refused, without the directory's name.
  std::string refusal(const std::string& text, const std::vector<std::string>& sets = {}) const {
    return refusal_of([&] { study(text, sets); });
  }
  /// Why what is done is refused.
  template <class Deed>
  std::string refusal_of(const Deed& deed) const {
    try {
      deed();
    } catch (const InputError& e) {
      std::string what = e.what();
      const std::string dir = here.path();
      for (auto at = what.find(dir); at != std::string::npos; at = what.find(dir)) {
        what.erase(at, dir.size());
      }
      return what;
    }
    return "(accepted)";
  }

  TemporaryDirectory here;
};

}  // namespace lilytank::test
