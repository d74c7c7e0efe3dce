// Searches: what they find, within which bounds, and that they can be stopped anywhere.
#include "lilytank/search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "lilytank/error.hpp"
#include "support/search_functions.hpp"

namespace lilytank {
namespace {

using Function = double (*)(const Point&);

/// Searches of every kind, small enough for a test.
std::vector<std::pair<std::string, std::unique_ptr<Search>>> every_kind(const SearchSpace& space,
                                                                        int iterations = 6) {
  std::vector<std::pair<std::string, std::unique_ptr<Search>>> out;
  for (const auto whom : {Neighbourhood::global, Neighbourhood::ring, Neighbourhood::von_neumann}) {
    for (const auto rule : {NoiseRule::none, NoiseRule::reevaluate, NoiseRule::ocba}) {
      SwarmOptions o;
      o.particles = 9, o.iterations = iterations, o.neighbourhood = whom, o.noise = rule;
      o.evaluations = rule == NoiseRule::none ? 1 : 3;
      o.final_evaluations = whom == Neighbourhood::ring ? 40 : 0;
      o.common_random_numbers = whom == Neighbourhood::von_neumann;
      o.at_bound = AtBound(static_cast<int>(whom));
      out.emplace_back(name_of(whom) + " " + name_of(rule), make_swarm(space, o, 7));
    }
  }
  for (const bool uncertain : {false, true}) {
    CmaEsOptions o;
    o.budget = 50 * iterations, o.handle_uncertainty = uncertain,
    o.final_evaluations = uncertain ? 40 : 0;
    o.common_random_numbers = uncertain;
    out.emplace_back(uncertain ? "cma-es, uncertain" : "cma-es", make_cma_es(space, o, 7));
  }
  return out;
}

TEST(Search, SpendsItsBudgetWithinTheBounds) {
  const SearchSpace space{{"a", -3, -1}, {"b", 1e-5, 0.5, true}, {"c", 0, 1e6}};
  for (const auto& [name, search] : every_kind(space)) {
    std::int64_t count = 0;
    std::set<std::int64_t> replicates;
    carry_through(*search, [&](const Trial& t) {
      ++count;
      replicates.insert(t.replicate);
      for (std::size_t a = 0; a < space.size(); ++a) {
        EXPECT_GE(t.point[a], space[a].low) << name;
        EXPECT_LE(t.point[a], space[a].high) << name;
      }
      return t.point[0] - t.point[1] + 1e-6 * t.point[2];  // lowest in a corner
    });
    EXPECT_EQ(search->evaluations(), count);
    EXPECT_LE(count, search->budget()) << name;
    EXPECT_GT(search->done(), 0.9) << name;
    EXPECT_TRUE(search->ask().empty());
    EXPECT_EQ(search->history().back().evaluations, count) << name;
    EXPECT_EQ(search->history().back().best, search->best().mean) << name;
    const bool selects = name.find("ring") == 0 || name.find("uncertain") != std::string::npos;
    EXPECT_EQ(search->selected(), selects) << name;
    const bool common = name.find("von") == 0 || name.find("uncertain") != std::string::npos;
    const auto different = static_cast<std::int64_t>(replicates.size());
    EXPECT_TRUE(common ? different < count / 2 : different == count) << name;
  }
}

TEST(Search, SwarmsFindTheLowestPoints) {
  for (const auto whom : {Neighbourhood::global, Neighbourhood::ring, Neighbourhood::von_neumann}) {
    SwarmOptions o;
    o.neighbourhood = whom, o.noise = NoiseRule::none, o.evaluations = 1;
    const auto end = [&](Function function) {
      const auto search = make_swarm(box(3), o, 1);
      carry_through(*search, [&](const Trial& t) { return function(t.point); });
      EXPECT_EQ(search->best().mean, function(search->best().point));
      return search->best().mean;
    };
    EXPECT_LT(end(sphere), 1e-2) << name_of(whom);
    EXPECT_LT(end(rosenbrock), 1) << name_of(whom);
    EXPECT_LT(end(rastrigin), 3) << name_of(whom);  // one of the lowest few of 1000 valleys
  }
}

TEST(Search, CmaEsFindsTheLowestPoints) {
  const std::pair<const char*, Function> functions[] = {
      {"sphere", sphere}, {"ellipsoid", ellipsoid}, {"rosenbrock", rosenbrock}};
  for (const auto& [name, function] : functions) {
    CmaEsOptions o;
    o.budget = 6000, o.handle_uncertainty = false, o.final_evaluations = 0;
    const auto search = make_cma_es(box(5), o, 1);
    carry_through(*search, [f = function](const Trial& t) { return f(t.point); });
    EXPECT_LT(search->best().mean, 1e-8) << name;
  }
}

// By new starts with more samples.
TEST(Search, CmaEsLeavesValleysThatAreNotTheLowest) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CmaEsOptions o;
    o.budget = 20000, o.handle_uncertainty = false, o.final_evaluations = 0;
    const auto search = make_cma_es(box(3), o, seed);
    carry_through(*search, [](const Trial& t) { return rastrigin(t.point); });
    found += search->best().mean < 1e-8 ? 1 : 0;
  }
  EXPECT_GE(found, 4);
}

TEST(Search, FindsACornerOfTheBox) {
  for (const auto& [name, search] : every_kind(box(2), 20)) {
    carry_through(*search, [](const Trial& t) { return -t.point[0] + t.point[1]; });
    EXPECT_LT(search->best().mean, -8) << name;
  }
}

// On the bounds themselves, noise or not.
TEST(Search, CmaEsFindsLowestPointsOnBoundsExactly) {
  const auto search = make_cma_es(box(3), cma_es_for(2000), 1);
  carry_through(*search, [](const Trial& t) {
    const Point& p = t.point;
    return noisy((p[0] + 5) * (p[0] + 5) - p[1] + p[2] * p[2], t, 0.5, 1);
  });
  EXPECT_EQ(search->best().point[0], -5);
  EXPECT_EQ(search->best().point[1], 5);
  EXPECT_NEAR(search->best().point[2], 0, 1);
}

TEST(Search, RecommendedSettingsKeepToTheBudget) {
  for (const std::int64_t budget : {120, 600, 9400}) {
    const auto swarm = make_swarm(box(3), swarm_for(budget, 15), 1);
    EXPECT_LE(swarm->budget(), budget);
    EXPECT_GT(swarm->budget(), budget - 30);
    EXPECT_EQ(make_cma_es(box(3), cma_es_for(budget), 1)->budget(), budget);
  }
}

TEST(Search, LogAxesAreSearchedByRatios) {
  const SearchSpace space{{"k", 1e-6, 1, true}};
  SwarmOptions o;
  o.particles = 400, o.iterations = 1, o.noise = NoiseRule::none;
  int below = 0;
  for (const Trial& t : make_swarm(space, o, 1)->ask()) below += t.point[0] < 1e-3 ? 1 : 0;
  EXPECT_NEAR(below, 400, 4 * 14.2);  // two evaluations a particle; 4 standard errors
}

// Everything a search will do is in its text: it is taken up again after every ask and every tell.
TEST(Search, GoesOnFromItsTextToTheSameBits) {
  const auto value = [](const Trial& t) {
    return t.replicate % 11 == 5 ? std::nan("") : noisy(sphere(t.point), t, 0.5, 3);
  };
  auto straight = every_kind(box(3)), broken = every_kind(box(3));
  for (std::size_t k = 0; k < straight.size(); ++k) {
    carry_through(*straight[k].second, value);
    std::unique_ptr<Search> search = std::move(broken[k].second);
    for (;;) {
      search = restore_search(search->save(), "saved");
      auto trials = search->ask();
      search = restore_search(search->save(), "saved");
      const auto again = search->ask();
      ASSERT_EQ(again.size(), trials.size());
      if (trials.empty()) break;
      std::vector<double> values;
      for (std::size_t i = 0; i < trials.size(); ++i) {
        EXPECT_EQ(again[i].point, trials[i].point);
        EXPECT_EQ(again[i].replicate, trials[i].replicate);
        values.push_back(value(trials[i]));
      }
      search->tell(values);
    }
    EXPECT_EQ(search->save(), straight[k].second->save()) << straight[k].first;
  }
}

TEST(Search, RefusesDamagedText) {
  for (const auto& [name, search] : every_kind(box(2))) {
    search->ask();
    const std::string text = search->save();
    for (std::size_t i = 0; i < text.size(); i += 7) {
      std::string damaged = text;
      damaged[i] = damaged[i] == '1' ? '2' : '1';
      EXPECT_THROW(restore_search(damaged, "saved"), InputError);
      EXPECT_THROW(restore_search(text.substr(0, i), "saved"), InputError);
    }
  }
  EXPECT_THROW(restore_search("lilytank search 2 swarm\n", "saved"), InputError);
}

// A diverged world is worse than every other one, and no reason to stop.
TEST(Search, ValuesThatAreNotFiniteAreTheWorst) {
  const double bad[] = {std::nan(""), std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
  for (auto& [name, search] : every_kind(box(2))) {
    carry_through(*search, [&](const Trial& t) {
      return t.point[0] > 0 ? bad[t.replicate % 3] : sphere(t.point);
    });
    EXPECT_LE(search->best().point[0], 0) << name;
    EXPECT_TRUE(std::isfinite(search->best().mean)) << name;
  }
  for (auto& [name, search] : every_kind(box(2))) {
    carry_through(*search, [](const Trial&) { return std::nan(""); });
    EXPECT_EQ(search->best().mean, std::numeric_limits<double>::infinity()) << name;
  }
}

TEST(Search, ToldTheWrongCountItThrows) {
  for (const auto& [name, search] : every_kind(box(2))) {
    const std::vector<double> none;
    EXPECT_THROW(search->tell(none), std::logic_error);
    std::vector<double> values(search->ask().size() + 1, 0.0);
    EXPECT_THROW(search->tell(values), std::logic_error);
    EXPECT_TRUE(search->best().point.empty());
  }
}

TEST(Swarm, StartsWhereItIsTold) {
  SwarmOptions o;
  o.starts = {{1, 2}, {-5, 5}};
  const auto trials = make_swarm(box(2), o, 1)->ask();
  EXPECT_NEAR(trials[0].point[0], 1, 1e-12);
  EXPECT_NEAR(trials[0].point[1], 2, 1e-12);
  EXPECT_EQ(trials[1].point, (Point{-5, 5}));  // one evaluation of each at first
}

// With Pedersen's negative inertia an unlimited swarm grows without bound.
TEST(Swarm, StepsKeepToTheVelocityLimit) {
  SwarmOptions o;
  o.particles = 10, o.iterations = 30, o.noise = NoiseRule::none, o.evaluations = 1;
  o.velocity_limit = 0.1, o.at_bound = AtBound::keep;
  const auto search = make_swarm(box(3), o, 1);
  std::vector<Trial> before;
  for (auto trials = search->ask(); !trials.empty(); trials = search->ask()) {
    std::vector<double> values;
    for (const Trial& t : trials) values.push_back(sphere(t.point));
    search->tell(values);
    for (std::size_t i = 0; i < before.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_LE(std::fabs(trials[i].point[a] - before[i].point[a]), 0.1 * 10 + 1e-12);
      }
    }
    before = trials;
  }
}

TEST(Swarm, NeighboursAreMutualAndAsManyAsTheGraphSays) {
  EXPECT_EQ(neighbours_of(Neighbourhood::ring, 5, 0), (std::vector<int>{0, 1, 4}));
  // Three rows of four: left, right, up, down.
  EXPECT_EQ(neighbours_of(Neighbourhood::von_neumann, 12, 4), (std::vector<int>{1, 3, 4, 5, 7}));
  EXPECT_EQ(neighbours_of(Neighbourhood::global, 3, 1), (std::vector<int>{0, 1, 2}));
  for (const auto whom : {Neighbourhood::global, Neighbourhood::ring, Neighbourhood::von_neumann}) {
    for (const int particles : {2, 3, 4, 15, 47}) {
      for (int i = 0; i < particles; ++i) {
        const std::vector<int> mine = neighbours_of(whom, particles, i);
        EXPECT_TRUE(std::is_sorted(mine.begin(), mine.end()));
        EXPECT_EQ(std::set<int>(mine.begin(), mine.end()).size(), mine.size());
        EXPECT_TRUE(std::binary_search(mine.begin(), mine.end(), i));
        if (particles >= 15 && whom == Neighbourhood::von_neumann) {
          EXPECT_EQ(mine.size(), 5u);
        }
        for (const int j : mine) {
          ASSERT_GE(j, 0);
          ASSERT_LT(j, particles);
          const std::vector<int> theirs = neighbours_of(whom, particles, j);
          EXPECT_TRUE(std::binary_search(theirs.begin(), theirs.end(), i));
        }
      }
    }
  }
}

// The paper's rule of section 4.1: personal bests are looked at again, and their values averaged.
TEST(Swarm, LuckyPersonalBestsAreFoundOut) {
  const auto lucky = [](NoiseRule rule) {
    SwarmOptions o;
    o.particles = 15, o.iterations = 20, o.noise = rule;
    const auto search = make_swarm(box(3), o, 4);
    carry_through(*search, [](const Trial& t) { return noisy(sphere(t.point), t, 5, 9); });
    // How far its belief is below the truth.
    return sphere(search->best().point) - search->best().mean;
  };
  EXPECT_GT(lucky(NoiseRule::none), lucky(NoiseRule::reevaluate));
  EXPECT_GT(lucky(NoiseRule::none), lucky(NoiseRule::ocba));
}

// New values only: over many searches the final mean has no bias, and its standard error is right.
TEST(Search, TheFinalMeanIsHonest) {
  const int n = 200;
  for (const bool swarm : {true, false}) {
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= n; ++seed) {
      SwarmOptions s;
      s.particles = 8, s.iterations = 5, s.final_evaluations = 40;
      CmaEsOptions c;
      c.budget = 120, c.final_evaluations = 40;
      const auto search = swarm ? make_swarm(box(2), s, seed) : make_cma_es(box(2), c, seed);
      carry_through(*search, [&](const Trial& t) { return noisy(sphere(t.point), t, 2, seed); });
      sum += search->best().mean - sphere(search->best().point);
    }
    // A little below: the winner of ten, chosen by some 20 values with deviation 2. The bias of a
    // winner among its own early values would be over 2.
    EXPECT_LT(std::fabs(sum / n), 0.8) << swarm;
  }
}

// What one has already is given up only for something better: the start stands in a hole that no
// sample finds.
TEST(Search, CmaEsKeepsAStartThatNothingBeats) {
  const Point start{2, -3};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CmaEsOptions o;
    o.budget = 200, o.final_evaluations = 40, o.start = start;
    const auto search = make_cma_es(box(2), o, seed);
    carry_through(*search, [&](const Trial& t) {
      const double off = std::hypot(t.point[0] - start[0], t.point[1] - start[1]);
      return noisy(off < 1e-9 ? -3 : sphere(t.point), t, 1, seed);
    });
    const Point best = search->best().point;
    EXPECT_NEAR(best[0], start[0], 1e-12) << seed;
    EXPECT_NEAR(best[1], start[1], 1e-12) << seed;
    EXPECT_GE(search->best().evaluations, 4) << seed;
  }
}

TEST(Search, PresetsAndWordsAreKnownByName) {
  for (const std::string& name : swarm_presets()) EXPECT_NO_THROW(swarm_preset(name));
  const SwarmOptions lilies = swarm_preset("paper-lilies");
  EXPECT_EQ(lilies.particles, 47);
  EXPECT_EQ(lilies.iterations, 100);
  EXPECT_EQ(lilies.inertia, -0.1832);
  const SwarmOptions rules = swarm_preset("paper-rulesets");
  EXPECT_EQ(rules.particles * rules.iterations * rules.evaluations, 600);
  EXPECT_THROW(swarm_preset("paper"), InputError);
  EXPECT_EQ(neighbourhood_named("von-neumann"), Neighbourhood::von_neumann);
  EXPECT_EQ(noise_rule_named(name_of(NoiseRule::ocba)), NoiseRule::ocba);
  try {
    noise_rule_named("obca");
    ADD_FAILURE() << "taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'ocba'?"), std::string::npos);
  }
}

TEST(Search, RefusesOptionsThatMakeNoSense) {
  const auto refused = [](const SearchSpace& space, const SwarmOptions& options) {
    EXPECT_THROW(make_swarm(space, options, 1), InputError);
  };
  refused({}, {});
  refused({{"x", 1, 1}}, {});
  refused({{"x", 0, 1, true}}, {});
  refused({{"x", 0, 1}, {"x", 0, 2}}, {});
  refused({{"a,b", 0, 1}}, {});
  refused({{"x", 0, std::numeric_limits<double>::infinity()}}, {});
  SwarmOptions o;
  o.particles = 1;
  refused(box(2), o);
  o = {}, o.evaluations = 1;  // nothing left to look at a personal best
  refused(box(2), o);
  o = {}, o.velocity_limit = 0;
  refused(box(2), o);
  o = {}, o.starts = {{0, 6}};
  refused(box(2), o);
  o = {}, o.final_evaluations = 2;
  refused(box(2), o);
  CmaEsOptions c;
  c.budget = 20;
  EXPECT_THROW(make_cma_es(box(2), c, 1), InputError);
  c = {}, c.sigma = 0;
  EXPECT_THROW(make_cma_es(box(2), c, 1), InputError);
  c = {}, c.start = {0};
  EXPECT_THROW(make_cma_es(box(2), c, 1), InputError);
}

}  // namespace
}  // namespace lilytank
