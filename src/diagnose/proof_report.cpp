// What sealed experiments say of a diagnosis, as text and as a table.
#include <algorithm>
#include <map>

#include "analysis/text_table.hpp"
#include "lilytank/proof.hpp"
#include "lilytank/statistics.hpp"
#include "text/number.hpp"

namespace lilytank {

bool ProofWorld::right() const {
  if (kind == "null") return verdict == Verdict::complete;
  if (verdict != Verdict::missing && verdict != Verdict::measurement) return false;
  if (kind == "unnamed") return said == "unnamed" && variable == effect;
  return said == effect ||
         std::find(alternatives.begin(), alternatives.end(), effect) != alternatives.end();
}

std::string proof_text(const Proof& proof) {
  struct Rate {
    int right = 0, wrong_name = 0, silent = 0, all = 0;
  };
  std::map<std::string, Rate> rates;
  std::map<std::pair<std::string, std::string>, int> taken;
  for (const ProofWorld& w : proof.worlds) {
    std::vector<std::string> groups{w.kind};
    if (w.kind == "named") {
      groups.push_back(w.expected_z >= 10  ? "named, z >= 10"
                       : w.expected_z >= 5 ? "named, 5 <= z < 10"
                                           : "named, z < 5");
    }
    for (const std::string& g : groups) {
      Rate& r = rates[g];
      r.all += 1, r.right += w.right() ? 1 : 0;
      r.silent += w.verdict == Verdict::complete && w.kind != "null" ? 1 : 0;
      r.wrong_name += !w.right() && !w.said.empty() && w.said != "unnamed" ? 1 : 0;
    }
    const std::string said = w.said.empty() ? name_of(w.verdict) : w.said;
    taken[{w.kind == "null"      ? "(nothing)"
           : w.kind == "unnamed" ? "odd " + w.effect
                                 : w.effect,
           said}] += 1;
  }
  std::string out = "proof on " + std::to_string(proof.worlds.size()) +
                    " sealed experiments, key " + proof.hash + "\n\n";
  TextTable table({"experiments", "n", "right", "95 % from", "to", "wrong name", "said complete"});
  for (const auto& [name, r] : rates) {
    const Estimate e = wilson(r.right, r.all);
    table.add({name, std::to_string(r.all), std::to_string(r.right), fixed(100 * e.low, 1) + " %",
               fixed(100 * e.high, 1) + " %", std::to_string(r.wrong_name),
               std::to_string(r.silent)});
  }
  out += table.text() + "\nwhat was taken for what\n";
  TextTable confusion({"key", "said", "times"});
  for (const auto& [pair, n] : taken) confusion.add({pair.first, pair.second, std::to_string(n)});
  return out + confusion.text();
}

std::string proof_csv(const Proof& proof) {
  std::string out = "world,kind,effect,expected_z,verdict,said,variable,z,alternatives,right\n";
  for (std::size_t i = 0; i < proof.worlds.size(); ++i) {
    const ProofWorld& w = proof.worlds[i];
    out += std::to_string(i) + "," + w.kind + "," + w.effect + "," + shortest(w.expected_z) + "," +
           name_of(w.verdict) + "," + w.said + "," + w.variable + "," + shortest(w.z) + ",";
    for (std::size_t k = 0; k < w.alternatives.size(); ++k) {
      out += (k > 0 ? " " : "") + w.alternatives[k];
    }
    out += w.right() ? ",1\n" : ",0\n";
  }
  return out;
}

}  // namespace lilytank
