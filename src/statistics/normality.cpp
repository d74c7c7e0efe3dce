#include "lilytank/normality.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lilytank {
namespace {

// Upper tail probabilities, and for sizes n the scaled distances that are exceeded with them.
constexpr std::array kTail = {0.9999, 0.999, 0.99, 0.95, 0.9,   0.8,  0.7,   0.6,   0.5,   0.4,
                              0.3,    0.2,   0.1,  0.05, 0.025, 0.01, 0.005, 0.002, 0.001, 0.0001};
struct TableRow {
  int n;
  std::array<double, kTail.size()> distance;
};
constexpr TableRow kTable[] = {
    {4, {0.3174, 0.3213, 0.3493, 0.4073, 0.4506, 0.5104, 0.5551, 0.5916, 0.6235, 0.6548,
         0.6891, 0.7314, 0.8341, 0.9065, 0.9556, 0.9966, 1.0180, 1.0359, 1.0445, 1.0593}},
    {5, {0.2824, 0.3041, 0.3534, 0.4192, 0.4597, 0.5090, 0.5441, 0.5757, 0.6083, 0.6455,
         0.6950, 0.7541, 0.8309, 0.8939, 0.9571, 1.0331, 1.0762, 1.1181, 1.1422, 1.1907}},
    {6, {0.2723, 0.3047, 0.3602, 0.4218, 0.4568, 0.5002, 0.5359, 0.5713, 0.6095, 0.6509,
         0.6954, 0.7488, 0.8276, 0.9002, 0.9629, 1.0308, 1.0780, 1.1408, 1.1789, 1.2651}},
    {8, {0.2747, 0.3107, 0.3625, 0.4150, 0.4479, 0.4956, 0.5353, 0.5720, 0.6079, 0.6461,
         0.6896, 0.7447, 0.8266, 0.8980, 0.9622, 1.0374, 1.0879, 1.1485, 1.1920, 1.3197}},
    {10, {0.2783, 0.3113, 0.3587, 0.4117, 0.4466, 0.4946, 0.5331, 0.5690, 0.6049, 0.6434,
          0.6874, 0.7426, 0.8246, 0.8965, 0.9611, 1.0376, 1.0896, 1.1544, 1.2013, 1.3298}},
    {20, {0.2765, 0.3097, 0.3579, 0.4118, 0.4456, 0.4924, 0.5306, 0.5658, 0.6014, 0.6398,
          0.6835, 0.7379, 0.8204, 0.8932, 0.9590, 1.0392, 1.0958, 1.1662, 1.2131, 1.3599}},
    {50, {0.2807, 0.3138, 0.3610, 0.4139, 0.4482, 0.4947, 0.5325, 0.5677, 0.6033, 0.6413,
          0.6843, 0.7388, 0.8203, 0.8929, 0.9604, 1.0439, 1.1011, 1.1722, 1.2241, 1.3660}},
    {100, {0.2785, 0.3162, 0.3640, 0.4181, 0.4517, 0.4979, 0.5351, 0.5700, 0.6054, 0.6432,
           0.6869, 0.7413, 0.8240, 0.8964, 0.9644, 1.0471, 1.1051, 1.1747, 1.2210, 1.3989}},
    {400, {0.2919, 0.3213, 0.3689, 0.4222, 0.4566, 0.5036, 0.5411, 0.5754, 0.6107, 0.6487,
           0.6912, 0.7460, 0.8279, 0.9011, 0.9684, 1.0507, 1.1096, 1.1815, 1.2366, 1.4427}},
};

double normal_distribution(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

// Between two entries the logarithm of the odds is nearly straight in the distance.
double tail_of(const std::array<double, kTail.size()>& distances, double d) {
  if (d <= distances.front()) return kTail.front();
  if (d >= distances.back()) return kTail.back();
  const auto above = std::upper_bound(distances.begin(), distances.end(), d);
  const auto i = static_cast<std::size_t>(above - distances.begin());
  const double t = (d - distances[i - 1]) / (distances[i] - distances[i - 1]);
  const auto logit = [](double p) { return std::log(p / (1 - p)); };
  const double odds = (1 - t) * logit(kTail[i - 1]) + t * logit(kTail[i]);
  return 1 / (1 + std::exp(-odds));
}

}  // namespace

double lilliefors_p(double distance, int n) {
  const double root = std::sqrt(static_cast<double>(n));
  const double scaled = distance * (root - 0.01 + 0.85 / root);
  const std::size_t rows = std::size(kTable);
  if (n >= kTable[rows - 1].n) return tail_of(kTable[rows - 1].distance, scaled);
  std::size_t i = 1;
  while (kTable[i].n < n) ++i;
  const TableRow &low = kTable[i - 1], &high = kTable[i];
  const double t = std::log(static_cast<double>(std::max(n, low.n)) / low.n) /
                   std::log(static_cast<double>(high.n) / low.n);
  std::array<double, kTail.size()> mixed;
  for (std::size_t k = 0; k < mixed.size(); ++k) {
    mixed[k] = (1 - t) * low.distance[k] + t * high.distance[k];
  }
  return tail_of(mixed, scaled);
}

double kolmogorov_p(double distance, int n) {
  const double root = std::sqrt(static_cast<double>(n));
  const double x = distance * (root + 0.12 + 0.11 / root);
  if (x < 0.2) return 1;
  double sum = 0;
  for (int k = 1; k <= 100; ++k) {
    const double term = std::exp(-2.0 * k * k * x * x);
    sum += k % 2 == 1 ? term : -term;
    if (term < 1e-12) break;
  }
  return std::clamp(2 * sum, 0.0, 1.0);
}

NormalityTest test_normality(std::vector<double> samples) {
  NormalityTest test;
  test.samples = static_cast<int>(samples.size());
  const double n = static_cast<double>(samples.size());
  if (samples.empty()) return test;
  for (const double v : samples) test.mean += v / n;
  double squares = 0;
  for (const double v : samples) squares += (v - test.mean) * (v - test.mean);
  if (samples.size() > 1) test.deviation = std::sqrt(squares / (n - 1));
  if (samples.size() < 4 || !(test.deviation > 0)) return test;
  std::sort(samples.begin(), samples.end());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double f = normal_distribution((samples[i] - test.mean) / test.deviation);
    const double below = static_cast<double>(i) / n, above = static_cast<double>(i + 1) / n;
    test.distance = std::max({test.distance, f - below, above - f});
  }
  test.raw_p = kolmogorov_p(test.distance, test.samples);
  test.p = lilliefors_p(test.distance, test.samples);
  return test;
}

std::vector<bool> false_discovery(const std::vector<double>& p, double rate) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!std::isnan(p[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<bool> rejected(p.size(), false);
  std::size_t last = 0;  // number of rejected hypotheses
  for (std::size_t k = 1; k <= order.size(); ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(order.size());
    if (p[order[k - 1]] <= rate * share) last = k;
  }
  for (std::size_t k = 0; k < last; ++k) rejected[order[k]] = true;
  return rejected;
}

}  // namespace lilytank
