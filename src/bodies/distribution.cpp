#include "bodies/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "statistics/quantiles.hpp"

namespace lilytank::bodies {
namespace {

struct WeightedMean {
  double mean = 0, weight = 0, squares = 0;  // squares: weighted, about the mean
};

double variance_of(const FoundParameter& p) {
  return std::pow((p.high - p.low) / (2 * normal_half_width()), 2);
}

// With so much variance between the values beside their errors.
WeightedMean weighted(std::span<const FoundParameter> values, double between) {
  WeightedMean out;
  for (const FoundParameter& p : values) {
    const double w = 1 / (variance_of(p) + between);
    out.weight += w, out.mean += w * p.value;
  }
  out.mean /= out.weight;
  for (const FoundParameter& p : values) {
    out.squares += std::pow(p.value - out.mean, 2) / (variance_of(p) + between);
  }
  return out;
}

// The variance between the values at which their weighted squares fall to `wanted`; 0 if they are
// below it without any.
double variance_at(std::span<const FoundParameter> values, double wanted) {
  if (weighted(values, 0).squares <= wanted) return 0;
  double low = 0, high = 1e-300;
  for (const FoundParameter& p : values) high = std::max(high, variance_of(p));
  while (weighted(values, high).squares > wanted) low = high, high *= 2;
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    (weighted(values, middle).squares > wanted ? low : high) = middle;
  }
  return high;
}

bool has_errors(std::span<const FoundParameter> values) {
  return std::ranges::all_of(values, [](const FoundParameter& p) {
    return p.high > p.low && std::isfinite(p.high - p.low);
  });
}

// Weighted squares of values about A size^exponent, with the best A.
class PowerLaw {
 public:
  PowerLaw(std::span<const double> sizes, std::span<const FoundParameter> values)
      : sizes_(sizes), values_(values) {}

  // `scatter`: between the values, relative to the law.
  double squares(double exponent, double scatter) const {
    double factor = 0, sum = 0;
    for (int round = 0; round < kRounds; ++round) {
      double weights = 0, products = 0;
      sum = 0;
      for (std::size_t i = 0; i < sizes_.size(); ++i) {
        const double power = std::pow(sizes_[i] / sizes_[0], exponent), law = factor * power;
        const double w = 1 / (variance_of(values_[i]) + scatter * scatter * law * law);
        weights += w * power * power, products += w * power * values_[i].value;
        sum += w * std::pow(values_[i].value - law, 2);
      }
      factor = products / weights;
    }
    return sum;
  }

  double best(double scatter) const {
    double exponent = 0;
    for (const double step : {kCoarse, kStep}) {
      const double reach = step == kCoarse ? kMost : kCoarse, about = exponent;
      double least = 1e300;
      for (double at = about - reach; at <= about + reach; at += step) {
        const double now = squares(at, scatter);
        if (now < least) least = now, exponent = at;
      }
    }
    return exponent;
  }

  // The end of the interval about `from` in a direction; nothing beyond the largest exponents.
  std::optional<double> end(double from, double scatter, double most, int direction) const {
    for (double at = from; std::fabs(at) <= kMost; at += direction * kStep) {
      if (squares(at, scatter) > most) return at;
    }
    return std::nullopt;
  }

 private:
  static constexpr int kRounds = 4;
  static constexpr double kMost = 6, kCoarse = 0.25, kStep = 0.01;
  std::span<const double> sizes_;
  std::span<const FoundParameter> values_;
};

FoundParameter with(FoundParameter like, const std::string& name, const std::string& path,
                    double value, double low, double high) {
  like.name = name, like.path = path, like.value = value, like.low = low, like.high = high;
  return like;
}

}  // namespace

Distribution distribution_of(std::span<const FoundParameter> values) {
  const auto free = static_cast<double>(values.size() - 1);
  const WeightedMean fixed = weighted(values, 0);
  double squared_weights = 0;
  for (const FoundParameter& p : values) squared_weights += std::pow(variance_of(p), -2);
  const double between =
      std::max(0.0, (fixed.squares - free) / (fixed.weight - squared_weights / fixed.weight));
  const WeightedMean random = weighted(values, between);
  const double scatter = std::max(1.0, random.squares / free);
  const double half = student_half_width(free) * std::sqrt(scatter / random.weight);
  return {random.mean,
          random.mean - half,
          random.mean + half,
          std::sqrt(between),
          std::sqrt(variance_at(values, chi_squared_quantile(0.975, free))),
          std::sqrt(variance_at(values, chi_squared_quantile(0.025, free)))};
}

std::optional<Growth> growth_over(std::span<const double> sizes,
                                  std::span<const FoundParameter> values) {
  constexpr double kLeastRatio = 1.5;
  const auto [least, most] = std::ranges::minmax(sizes);
  if (sizes.size() < 4 || !(least > 0) || most < kLeastRatio * least) return std::nullopt;
  if (!has_errors(values)) return std::nullopt;
  const PowerLaw law(sizes, values);
  const double free = static_cast<double>(sizes.size()) - 2;
  double low = 0, high = 1;
  if (law.squares(law.best(0), 0) <= free) high = 0;
  for (int k = 0; k < 20 && high > 0; ++k) {
    const double middle = (low + high) / 2;
    (law.squares(law.best(middle), middle) > free ? low : high) = middle;
  }
  const double exponent = law.best(high);
  const double within = law.squares(exponent, high) + std::pow(student_half_width(free), 2);
  const auto from = law.end(exponent, high, within, -1), to = law.end(exponent, high, within, 1);
  if (!from || !to) return std::nullopt;
  return Growth{exponent, *from, *to};
}

std::vector<FoundParameter> summarized(const std::vector<FoundParameter>& of, std::size_t number,
                                       const std::string& groups) {
  constexpr std::size_t kLeast = 3;
  std::vector<FoundParameter> out;
  if (number <= kMostListed) out = of;
  std::vector<std::string> paths;
  std::map<std::string, std::vector<FoundParameter>> by_path;
  for (const FoundParameter& p : of) {
    if (by_path[p.path].empty()) paths.push_back(p.path);
    by_path[p.path].push_back(p);
  }
  const std::string among = " of " + std::to_string(number) + " " + groups;
  for (const std::string& path : paths) {
    std::vector<FoundParameter>& all = by_path[path];
    const std::string name = path.substr(path.find('.') + 1);
    std::ranges::sort(all, {}, &FoundParameter::value);
    const std::size_t n = all.size();
    if (number > kMostListed) {
      out.push_back(with(all[n / 2], name + ", median" + among + ", 2.5 % to 97.5 % of them", path,
                         all[n / 2].value, all[n / 40].value, all[n - 1 - n / 40].value));
      for (const auto& [what, p] :
           {std::pair{", smallest: ", &all.front()}, {", largest: ", &all.back()}})
        out.push_back(with(*p, name + what + p->name, path, p->value, p->low, p->high));
    }
    if (n < kLeast || !has_errors(all)) continue;
    const Distribution d = distribution_of(all);
    out.push_back(
        with(all[0], name + ", mean" + among, path + ".mean", d.mean, d.mean_low, d.mean_high));
    out.push_back(with(all[0], name + ", standard deviation between " + groups, path + ".between",
                       d.deviation, d.deviation_low, d.deviation_high));
  }
  return out;
}

}  // namespace lilytank::bodies
