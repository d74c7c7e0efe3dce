#include <algorithm>

#include "lilytank/statistics.hpp"
#include "statistics/linear.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank {
namespace {

struct Member {
  double time = 0;
  bool observed = true;
  Eigen::Index group = 0;
};

// Members of all groups by rising time.
std::vector<Member> members_of(const std::vector<std::vector<Duration>>& groups) {
  std::vector<Member> members;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const Duration& d : groups[g]) {
      members.push_back({d.time, d.observed, static_cast<Eigen::Index>(g)});
    }
  }
  std::stable_sort(members.begin(), members.end(),
                   [](const Member& a, const Member& b) { return a.time < b.time; });
  return members;
}

// Observed minus expected events of each group, and their covariance if all groups are alike.
struct Excess {
  Eigen::VectorXd events;
  Eigen::MatrixXd covariance;
};

Excess excess_of(const std::vector<std::vector<Duration>>& groups) {
  const auto count = static_cast<Eigen::Index>(groups.size());
  Excess excess{Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
  Eigen::VectorXd at_risk(count);
  for (Eigen::Index g = 0; g < count; ++g) {
    at_risk[g] = static_cast<double>(groups[static_cast<std::size_t>(g)].size());
  }
  const std::vector<Member> members = members_of(groups);
  for (std::size_t i = 0; i < members.size();) {
    const double time = members[i].time;
    const auto n = static_cast<double>(members.size() - i);
    Eigen::VectorXd events = Eigen::VectorXd::Zero(count), leaving = events;
    for (; i < members.size() && members[i].time == time; ++i) {
      leaving[members[i].group] += 1;
      if (members[i].observed) events[members[i].group] += 1;
    }
    const double d = events.sum();
    if (d > 0) {
      const Eigen::VectorXd share = at_risk / n;
      excess.events += events - d * share;
      if (n > 1) {
        const double spread = d * (n - d) / (n - 1);
        excess.covariance.diagonal() += spread * share;
        excess.covariance -= spread * share * share.transpose();
      }
    }
    at_risk -= leaving;
  }
  return excess;
}

}  // namespace

TestResult log_rank(const std::vector<std::vector<Duration>>& groups) {
  const Excess excess = excess_of(groups);
  if (groups.empty() || !(excess.covariance.diagonal().maxCoeff() > 0)) return {};
  // The covariance is singular along (1, 1, ...), and along each group that was empty at every
  // event; what is left are the degrees of freedom.
  const RankedSolution solved = solve_ranked(excess.covariance, excess.events, 1e-10);
  TestResult result;
  result.degrees = static_cast<double>(solved.rank);
  if (solved.rank == 0) return result;
  result.statistic = std::max(0.0, excess.events.dot(solved.x));
  result.p = chi_squared_tail(result.statistic, result.degrees);
  return result;
}

}  // namespace lilytank
