#include "finder/scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "lilytank/study.hpp"
#include "scores/scores.hpp"
#include "statistics/largest_first.hpp"

namespace lilytank {
namespace {

constexpr double kSpacing = 0.16, kFarthest = 0.8;  // of the tank's radius
constexpr double kWidths[] = {0.04, 0.06, 0.09};    // m
constexpr double kMapWidth = kWidths[1];
constexpr double kPlacesApart = 0.06;                    // m, of places that are tried
constexpr std::size_t kTriedPlaces = 3, kTriedNear = 4;  // of each way to rank them
// Between places of the grid: halvings of the step, most steps of a length, and the first steps'
// factor on a width.
constexpr int kHalvings = 2, kMostSteps = 3;
constexpr double kWider = 1.3;
constexpr double kLonger = 1.25;   // from a range to the next that is tried
constexpr double kClearRise = 30;  // twice a log-likelihood: a rise that is no chance

std::vector<FoundPlace> grid_of(const Model& model, std::span<const double> widths) {
  std::vector<FoundPlace> places;
  const double R = model.tank.radius, step = kSpacing * R, row = step * std::sqrt(0.75);
  const int most = static_cast<int>(std::ceil(kFarthest * R / row));
  for (int j = -most; j <= most; ++j) {
    for (int i = -most; i <= most; ++i) {
      const double x = step * (i + (j % 2 == 0 ? 0 : 0.5)), y = row * j;
      if (std::hypot(x, y) > kFarthest * R) continue;
      for (const double width : widths) places.push_back({x, y, width, {}});
    }
  }
  return places;
}

Effect at(const Effect& effect, const FoundPlace& place) {
  return placed(effect, place.x, place.y, place.width);
}

Model with_placed(const Model& model, const Effect& effect, const FoundPlace& place) {
  std::vector<double> amplitudes = place.amplitudes;
  for (std::size_t c = 0; c < amplitudes.size(); ++c) amplitudes[c] *= effect.sizes[c];
  return with_effect(model, at(effect, place), amplitudes);
}

// Of the components of one effect at every place, in turn.
void add_amplitudes(std::span<const Sensitivities::Amplitude> scored, std::size_t components,
                    std::vector<FoundPlace>& places) {
  for (std::size_t k = 0; k < scored.size(); ++k) {
    FoundPlace& place = places[k / components];
    place.amplitudes.push_back(scored[k].estimate), place.gain += scored[k].gain();
  }
}

std::vector<FoundPlace> map_of(std::vector<FoundPlace> places) {
  std::erase_if(places, [](const FoundPlace& place) { return place.width != kMapWidth; });
  std::ranges::sort(places, {},
                    [](const FoundPlace& place) { return std::pair(place.y, place.x); });
  return places;
}

// An effect of each term that has a place.
std::vector<const Effect*> effects_somewhere(const ScorePlan& plan) {
  std::vector<const Effect*> out;
  for (const Effect& effect : plan.effects) {
    const bool of_term =
        std::ranges::any_of(out, [&](const Effect* one) { return one->term == effect.term; });
    if (effect.estimated == Estimated::place && !of_term) out.push_back(&effect);
  }
  return out;
}

double apart(const FoundPlace& a, const FoundPlace& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

// The first places that are not close to an earlier one.
std::vector<FoundPlace> leading(const std::vector<FoundPlace>& ranking) {
  std::vector<FoundPlace> out;
  for (const FoundPlace& place : ranking) {
    const bool near = std::any_of(out.begin(), out.end(), [&](const FoundPlace& one) {
      return apart(one, place) < kPlacesApart;
    });
    if (!near) out.push_back(place);
    if (out.size() == kTriedPlaces) break;
  }
  return out;
}

// The first places near `centre`.
std::vector<FoundPlace> around(const FoundPlace& centre, const std::vector<FoundPlace>& ranking) {
  std::vector<FoundPlace> out;
  for (const FoundPlace& place : ranking) {
    if (apart(centre, place) < kPlacesApart) out.push_back(place);
    if (out.size() == kTriedNear) break;
  }
  return out;
}

// The search for the likeliest place of an effect.
class PlaceSearch {
 public:
  PlaceSearch(const ScorePlan& plan, const Effect& effect, const std::vector<Recording>& recordings,
              int threads)
      : plan_(plan), effect_(effect), recordings_(recordings), threads_(threads) {}

  PlaceScan run() {
    std::vector<FoundPlace> cleared, as_drawn;
    for_each_world(2, threads_, [&](int i) {
      (i == 0 ? cleared : as_drawn) = ranked(grid_of(plan_.model, kWidths), i == 1);
    });
    const double without = deviance_of(plan_, recordings_);
    attempt(leading(cleared), leading(as_drawn));
    attempt(around(best_, cleared), around(best_, as_drawn));
    if (without - least_ > kClearRise) refine();
    best_.gain = without - least_;
    return {best_, map_of(std::move(cleared))};
  }

 private:
  // Linear estimates of the amplitudes at places, by descending gain. A smooth error of the flow is
  // almost collinear with a wide stream: orthogonalised against it, speed and place are biased;
  // without that, an error of the flow is scored as a stream.
  std::vector<FoundPlace> ranked(std::vector<FoundPlace> places, bool flow_as_drawn) const {
    ScorePlan scan = plan_;
    scan.effects.clear(), scan.shapes.clear();
    for (const FoundPlace& place : places) scan.effects.push_back(at(effect_, place));
    if (flow_as_drawn) scan.nuisances.reset();
    const std::vector<Sensitivities::Amplitude> scored = scored_amplitudes(scan, recordings_);
    add_amplitudes(scored, effect_.paths.size(), places);
    largest_first(places, &FoundPlace::gain);
    return places;
  }

  // Whether one of these is the likeliest so far.
  bool attempt(std::vector<FoundPlace> tried, const std::vector<FoundPlace>& more = {}) {
    tried.insert(tried.end(), more.begin(), more.end());
    std::erase(tried, best_);  // known already
    std::vector<double> deviance(tried.size());
    for_each_world(static_cast<int>(tried.size()), threads_, [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      ScorePlan with = plan_;
      with.model = with_placed(plan_.model, effect_, tried[k]);
      deviance[k] = deviance_of(with, recordings_);
    });
    const auto lowest = std::min_element(deviance.begin(), deviance.end());
    if (lowest == deviance.end() || !(*lowest < least_)) return false;
    least_ = *lowest, best_ = tried[static_cast<std::size_t>(lowest - deviance.begin())];
    return true;
  }

  // Towards a likelier place and width between those of the grid, in ever smaller steps, and
  // amplitudes that a filter with the effect in its model finds there.
  void refine() {
    attempt({corrected()});
    double step = 0.5 * kSpacing * plan_.model.tank.radius, factor = kWider;
    for (int halving = 0; halving < kHalvings; ++halving) {
      for (int k = 0; k < kMostSteps && attempt(neighbours(step, factor)); ++k) {
        attempt({corrected()});
      }
      step *= 0.5, factor = std::sqrt(factor);
    }
  }

  FoundPlace corrected() const {
    ScorePlan with = plan_;
    with.model = with_placed(plan_.model, effect_, best_);
    const Eigen::VectorXd more =
        joint_amplitudes(with, recordings_, {at(effect_, best_)}).front().estimate;
    FoundPlace out = best_;
    for (std::size_t c = 0; c < out.amplitudes.size(); ++c) {
      out.amplitudes[c] += more(static_cast<Eigen::Index>(c));
    }
    return out;
  }

  std::vector<FoundPlace> neighbours(double step, double factor) const {
    std::vector<FoundPlace> out(8, best_);
    for (std::size_t k = 0; k < 6; ++k) {
      const Rot way = rotation(kPi / 3 * static_cast<double>(k));
      out[k].x += step * way.c, out[k].y += step * way.s;
    }
    out[6].width *= factor, out[7].width /= factor;
    const FitParameter &edge = effect_.refine[0], &width = effect_.refine[2];
    std::erase_if(out, [&](const FoundPlace& place) {
      return std::hypot(place.x, place.y) > edge.high || place.width < width.low ||
             place.width > width.high;
    });
    return out;
  }

  const ScorePlan& plan_;
  const Effect& effect_;
  const std::vector<Recording>& recordings_;
  int threads_;
  FoundPlace best_;
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace

PlaceScan find_place(const ScorePlan& plan, const Effect& effect,
                     const std::vector<Recording>& recordings, int threads) {
  return PlaceSearch(plan, effect, recordings, threads).run();
}

std::vector<LinearPlaces> linear_places(const ScorePlan& plan,
                                        const std::vector<Recording>& recordings) {
  ScorePlan scan = plan;
  scan.effects.clear(), scan.shapes.clear();
  std::vector<LinearPlaces> out;
  for (const Effect* effect : effects_somewhere(plan)) {
    out.push_back({effect, grid_of(plan.model, {&kMapWidth, 1})});
    for (const FoundPlace& place : out.back().places) scan.effects.push_back(at(*effect, place));
  }
  const std::vector<Sensitivities::Amplitude> scored = scored_amplitudes(scan, recordings);
  std::span<const Sensitivities::Amplitude> rest = scored;
  for (LinearPlaces& one : out) {
    const std::size_t components = one.effect->paths.size(), n = components * one.places.size();
    add_amplitudes(rest.first(n), components, one.places), rest = rest.subspan(n);
  }
  return out;
}

std::map<const ForceTerm*, ScannedValue> find_values(const ScorePlan& plan,
                                                     const std::vector<Recording>& recordings) {
  ScorePlan scan = plan;
  scan.effects.clear(), scan.shapes.clear();
  std::set<const ForceTerm*> done;  // the first range of the catalogue stands for all
  for (const Effect& effect : plan.effects) {
    if (!(effect.scanned_from > 0) || !done.insert(effect.term).second) continue;
    const double longest = effect.refine[0].high;
    for (double range = effect.scanned_from; range < longest; range *= kLonger) {
      scan.effects.push_back(effect);
      scan.effects.back().held[0].value = range;
    }
  }
  const std::vector<Sensitivities::Amplitude> scored = scored_amplitudes(scan, recordings);
  std::map<const ForceTerm*, ScannedValue> out;
  std::map<const ForceTerm*, double> most;
  for (std::size_t k = 0; k < scored.size(); ++k) {
    const Effect& effect = scan.effects[k];
    const bool may_be_negative =
        effect.two_sided ||
        std::any_of(plan.effects.begin(), plan.effects.end(),
                    [&](const Effect& e) { return e.negative_of == effect.term; });
    double& best = most.emplace(effect.term, kClearRise).first->second;
    if (!(scored[k].gain() > best) || (!may_be_negative && scored[k].estimate < 0)) continue;
    best = scored[k].gain(), out[effect.term] = {effect.held[0].value, scored[k].estimate};
  }
  return out;
}

Scans scans_of(const ScorePlan& plan, const std::vector<Recording>& recordings, int threads) {
  const std::vector<const Effect*> somewhere = effects_somewhere(plan);
  Scans out;
  std::vector<PlaceScan> places(somewhere.size());
  for_each_world(static_cast<int>(somewhere.size()) + 1, threads, [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    if (k == somewhere.size()) {
      out.values = find_values(plan, recordings);
    } else {
      places[k] = find_place(plan, *somewhere[k], recordings, threads);
    }
  });
  for (std::size_t k = 0; k < places.size(); ++k) out.places[somewhere[k]->term] = places[k];
  return out;
}

}  // namespace lilytank
