// Which search finds the better point with the same number of noisy evaluations?
//
//   search_yardstick [--seeds=N] [--only=WORD] [--cases=WORD] [--csv=FILE]
//
// For each case and contestant the median and quartiles over the seeds of the true value at the
// point that it ends with (0 is perfect, 1 the average over the box); last the geometric means of
// the medians. FILE gets one row a run.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include "search_contestants.hpp"
#include "text/number.hpp"

namespace lilytank::bench {
namespace {

/// Differences below this are of no use to anybody and do not count in the means.
constexpr double kNegligible = 1e-4;

struct Options {
  int seeds = 25;
  std::string only, cases, csv;
};

Options options_from(int count, char** words) {
  Options out;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const auto value = word.substr(std::min(word.find('=') + 1, word.size()));
    if (word.starts_with("--seeds=")) out.seeds = static_cast<int>(parse_whole(value).value_or(25));
    if (word.starts_with("--only=")) out.only = value;
    if (word.starts_with("--cases=")) out.cases = value;
    if (word.starts_with("--csv=")) out.csv = value;
  }
  return out;
}

/// The calibration's and the ruleset search's size in the paper, and a tight budget.
std::vector<SearchCase> cases() {
  std::vector<SearchCase> out;
  for (const std::string& function : search_functions()) {
    for (const double noise : {0.03, 0.3}) {
      out.push_back({function, 3, 600, 15, noise});
      out.push_back({function, 5, 1880, 47, noise});
      out.push_back({function, 5, 9400, 47, noise});
    }
  }
  return out;
}

std::string title(const SearchCase& c) {
  return c.function + " n=" + std::to_string(c.axes) + " " + std::to_string(c.budget) + " noise " +
         shortest(c.noise);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

/// The true values at which a contestant ends, seed by seed.
std::vector<double> ends(const SearchContestant& contestant, const SearchCase& what,
                         const Options& options, std::ostream& csv) {
  std::vector<double> out;
  for (int s = 1; s <= options.seeds; ++s) {
    const auto seed = static_cast<std::uint64_t>(s);
    const SearchObjective objective = search_objective(what, seed);
    const SearchOutcome end = contestant.run(objective, what, seed);
    out.push_back(objective.truth(end.point));
    csv << '"' << contestant.name << "\"," << what.function << "," << what.axes << ","
        << what.budget << "," << shortest(what.noise) << "," << s << "," << end.evaluations << ","
        << shortest(out.back()) << "," << shortest(end.told) << "\n";
  }
  return out;
}

void print_means(const std::vector<SearchContestant>& contestants,
                 const std::vector<SearchCase>& all,
                 const std::vector<std::vector<double>>& medians) {
  std::cout << "geometric means over the cases: all, noise 0.03, noise 0.3\n";
  for (std::size_t c = 0; c < contestants.size(); ++c) {
    double sum[2] = {0, 0};
    int count[2] = {0, 0};
    for (std::size_t k = 0; k < all.size(); ++k) {
      const int loud = all[k].noise > 0.1 ? 1 : 0;
      sum[loud] += std::log(std::max(medians[c][k], kNegligible)), ++count[loud];
    }
    char line[160];
    std::snprintf(line, sizeof line, "  %-46s %9.2e %9.2e %9.2e", contestants[c].name.c_str(),
                  std::exp((sum[0] + sum[1]) / (count[0] + count[1])), std::exp(sum[0] / count[0]),
                  std::exp(sum[1] / count[1]));
    std::cout << line << "\n";
  }
}

std::vector<SearchContestant> contestants_for(const Options& options) {
  std::vector<SearchContestant> out = own_contestants();
#ifdef LILYTANK_WITH_PAGMO
  for (const SearchContestant& c : pagmo_contestants()) out.push_back(c);
#endif
  std::erase_if(out, [&](const SearchContestant& c) {
    return c.name.find(options.only) == std::string::npos;
  });
  return out;
}

int run(const Options& options) {
  const std::vector<SearchContestant> contestants = contestants_for(options);
  std::vector<SearchCase> all = cases();
  std::erase_if(all, [&](const SearchCase& what) {
    return title(what).find(options.cases) == std::string::npos;
  });
  std::ofstream csv;
  if (!options.csv.empty()) csv.open(options.csv);
  csv << "search,function,axes,budget,noise,seed,evaluations,true_value,believed_value\n";
  std::vector<std::vector<double>> medians(contestants.size());
  for (const SearchCase& what : all) {
    std::cout << title(what) << "\n";
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      const std::vector<double> values = ends(contestants[c], what, options, csv);
      medians[c].push_back(quantile(values, 0.5));
      char line[160];
      std::snprintf(line, sizeof line, "  %-46s %10.2e  (quartiles %.1e %.1e)",
                    contestants[c].name.c_str(), medians[c].back(), quantile(values, 0.25),
                    quantile(values, 0.75));
      std::cout << line << std::endl;
    }
  }
  print_means(contestants, all, medians);
  return 0;
}

}  // namespace
}  // namespace lilytank::bench

int main(int count, char** words) {
  return lilytank::bench::run(lilytank::bench::options_from(count, words));
}
