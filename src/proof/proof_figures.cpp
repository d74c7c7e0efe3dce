// What figures show of sealed experiments.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lilytank/proof.hpp"
#include "lilytank/statistics.hpp"

namespace lilytank {
namespace {

constexpr std::array<double, 5> kEdges = {0, 5, 10, 20, 1e300};  // of expected z

ProofPoint point_of(const ProofWorld& w) {
  ProofPoint out;
  out.row = w.kind == "two"       ? "two effects"
            : w.kind == "unnamed" ? "a law of no effect"
                                  : w.effects[0];
  out.expected_z = std::max(w.expected_z, ProofFigures::kLeastZ);
  // A wrong name is one, whatever is right beside it.
  if (w.wrong_name()) {
    out.outcome = ProofPoint::Outcome::wrong_name;
  } else if (w.right()) {
    out.outcome = ProofPoint::Outcome::right;
  } else if (w.verdict == Verdict::complete) {
    out.outcome = ProofPoint::Outcome::silent;
  }
  return out;
}

std::vector<ProofPower> power_of(std::span<const Proof> proofs, const std::string& kind) {
  std::array<ProofPower, kEdges.size() - 1> ranges;
  for (const Proof& p : proofs) {
    for (const ProofWorld& w : p.worlds) {
      if (w.kind != kind) continue;
      const auto above = std::upper_bound(kEdges.begin() + 1, kEdges.end() - 1, w.expected_z);
      ProofPower& of = ranges[static_cast<std::size_t>(above - kEdges.begin() - 1)];
      of.all += 1, of.right += w.right() ? 1 : 0;
      of.z += std::log(std::max(w.expected_z, ProofFigures::kLeastZ));
    }
  }
  std::vector<ProofPower> out;
  for (ProofPower of : ranges) {
    if (of.all == 0) continue;
    const Estimate share = wilson(of.right, of.all);
    of.z = std::exp(of.z / of.all), of.low = share.low, of.high = share.high;
    out.push_back(of);
  }
  return out;
}

double in_half_widths(const ProofInterval& of) {
  const double off = of.value - of.truth, half = off > 0 ? of.value - of.low : of.high - of.value;
  if (off == 0) return 0;
  return half > 0 ? off / half : std::copysign(std::numeric_limits<double>::infinity(), off);
}

}  // namespace

ProofFigures proof_figures(std::span<const Proof> proofs) {
  ProofFigures out;
  for (const Proof& p : proofs) {
    for (const ProofWorld& w : p.worlds) {
      if (w.kind != "null") out.points.push_back(point_of(w));
      for (const ProofInterval& of : w.intervals) {
        (of.of_effect(w.effects) ? out.effect_errors : out.baseline_errors)
            .push_back(in_half_widths(of));
      }
    }
  }
  std::sort(out.baseline_errors.begin(), out.baseline_errors.end());
  std::sort(out.effect_errors.begin(), out.effect_errors.end());
  out.named = power_of(proofs, "named"), out.two = power_of(proofs, "two");
  out.unnamed = power_of(proofs, "unnamed");
  return out;
}

}  // namespace lilytank
