// Which of the compared laws are reported, and which are not distinguished from them.
#include <algorithm>
#include <cmath>
#include <set>

#include "bodies/verdict.hpp"

namespace lilytank::bodies {

double Comparison::threshold() const {
  if (nulls.empty()) return 5;
  const auto n = static_cast<double>(nulls.size());
  const auto over = static_cast<std::size_t>(std::floor(false_alarms * (n + 1)));
  // Fewer nulls than the rate requires: the largest gain plus the log of the missing factor.
  if (over == 0) return std::max(0.0, nulls.back()) + std::log(1 / (false_alarms * (n + 1)));
  return std::max(0.0, nulls[nulls.size() - over]);
}

double Comparison::chance(double gain) const {
  const auto n = static_cast<double>(nulls.size());
  const auto over =
      static_cast<double>(nulls.end() - std::lower_bound(nulls.begin(), nulls.end(), gain));
  const double most = nulls.empty() ? 0 : std::max(0.0, nulls.back());
  return over > 0 ? (over + 1) / (n + 1) : std::exp(-std::max(0.0, gain - most)) / (n + 1);
}

namespace {

std::multiset<std::string_view> variables_of(const Candidate& candidate) {
  std::multiset<std::string_view> out;
  for (const Law* law : candidate.laws) out.insert(law->variable);
  return out;
}

}  // namespace

// A difference of many nat within a few blocks has a large standard error: beyond kFar nat, or
// kShare of the gain, it is evidence nevertheless. Where runs disagree by more than their errors,
// log-likelihoods differ by the square of that.
bool Comparison::by_gain(const LawTrial& better, const LawTrial& worse) const {
  constexpr double kFar = 30, kShare = 0.1;
  const double factor = repeats.factor();
  Difference d = difference(better.by_block, worse.by_block);
  d.error *= factor;
  return d.distinguished() || d.value > factor * factor * std::max(kFar, kShare * better.gain);
}

bool Comparison::distinguished(const LawTrial& better, const LawTrial& worse) const {
  constexpr double kMost = 30, kShare = 0.25;
  if (!by_gain(better, worse)) return false;
  const double factor = repeats.factor(), more = better.gain - worse.gain;
  // Errors of the recording explain small differences only.
  if (more > factor * factor * std::min(kMost, std::max(2.0, kShare * better.gain))) return true;
  // Laws of one variable: what no law explains must be less than what they differ by.
  const bool alike = variables_of(better.candidate) == variables_of(worse.candidate);
  if (alike && acceleration_difference(groups, better, worse) < 1) return false;
  if (better.shaken.empty() || worse.shaken.empty()) return true;
  Difference still = difference(better.shaken, worse.shaken);
  still.error *= factor;
  return still.distinguished();
}

// Outcomes of a trial's laws with one of them replaced by a special case of it.
std::vector<const LawTrial*> Comparison::special_cases(const LawTrial& of) const {
  std::vector<const LawTrial*> out;
  std::vector<const Law*> laws = of.candidate.laws;
  for (const Law*& one : laws) {
    const Law* const general = one;
    for (const std::string_view name : general->special) {
      one = find_law(name);
      const LawTrial* found = one != nullptr ? outcome_of(laws) : nullptr;
      if (found != nullptr) out.push_back(found);
    }
    one = general;
  }
  return out;
}

// Further parameters must predict better.
const LawTrial& Comparison::simplest(const LawTrial& of) const {
  const std::vector<const LawTrial*> special = special_cases(of);
  const auto best = std::ranges::max_element(special, {}, &LawTrial::gain);
  if (best == special.end() || (*best)->gain <= threshold() || by_gain(of, **best)) return of;
  return simplest(**best);
}

// The best named law; a pair or a triple where its last law gains more than chance gives; an
// unnamed law where it is distinguished from both, or where no named law is beyond chance.
const LawTrial& Comparison::choice() const {
  const auto first = [&](bool curve) {
    return std::find_if(singles.begin(), singles.end(),
                        [&](const LawTrial& o) { return o.candidate.curve() == curve; });
  };
  const auto named = first(false), unnamed = first(true);
  if (named == singles.end()) return *unnamed;
  const LawTrial* out = &*named;
  for (const std::vector<LawTrial>* more : {&pairs, &triples}) {
    if (more->empty()) continue;
    // The threshold is that of the best of all single laws: there are more sums to choose from.
    const auto times = static_cast<double>(more->size()) / static_cast<double>(singles.size());
    const double least = std::max(2.0, threshold()) + std::log(std::max(1.0, times));
    const LawTrial& sum = more->front();
    if (sum.gain - std::max(0.0, out->gain) > least && by_gain(sum, *out)) out = &sum;
  }
  const bool better = unnamed != singles.end() && unnamed->gain > out->gain;
  if (better && (out->gain <= threshold() || distinguished(*unnamed, *out))) out = &*unnamed;
  return simplest(*out);
}

void Comparison::select() {
  // The runs' disagreement widens the errors by which laws are distinguished, so that another law
  // may follow from it.
  for (int again = 0; again < 2; ++again) {
    const LawTrial* now = &choice();
    if (now == reported) return;
    reported = now, repeats = repeats_of(*experiment, groups, *reported);
  }
}

const std::vector<LawTrial>& Comparison::trials_of(std::size_t laws) const {
  return laws == 1 ? singles : laws == 2 ? pairs : triples;
}

const LawTrial* Comparison::outcome_of(std::span<const Law* const> laws) const {
  if (laws.empty()) return &baseline;
  for (const LawTrial& o : trials_of(laws.size())) {
    if (std::ranges::is_permutation(o.candidate.laws, laws)) return &o;
  }
  return nullptr;
}

std::vector<const LawTrial*> Comparison::alternatives() const {
  std::vector<const LawTrial*> out;
  for (const LawTrial& o : trials_of(reported->candidate.laws.size())) {
    const bool general = std::ranges::count(special_cases(o), reported) > 0;
    const bool other = &o != reported && !o.candidate.curve() && !general;
    if (other && o.gain > threshold() && !distinguished(*reported, o)) out.push_back(&o);
  }
  return out;
}

std::vector<const LawTrial*> Comparison::better_unnamed() const {
  std::vector<const LawTrial*> out;
  for (const LawTrial& o : singles) {
    if (o.candidate.curve() && o.gain > reported->gain) out.push_back(&o);
  }
  return out;
}

}  // namespace lilytank::bodies
