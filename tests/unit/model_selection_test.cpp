// Which effects explain residuals, on numbers of which everything is known.
#include "finder/model_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lilytank/random.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kNamed = 60, kCurves = 2, kNulls = 400;
constexpr double kFalseAlarms = 0.02;

double normal(std::uint64_t of, std::int64_t row, int column) {
  return normal_pair({of, Stream::calibrate, row, static_cast<std::uint32_t>(column), 3})[0];
}

// Independent numbers of deviation one.
Vector noise(std::uint64_t of, int row) {
  Vector out(kNamed + kCurves * kKnots);
  for (Eigen::Index k = 0; k < out.size(); ++k) out(k) = normal(of, row, static_cast<int>(k));
  return out;
}

// A direction among the named numbers.
Vector direction(std::uint64_t of) {
  Vector out = noise(of, 0);
  out.tail(kCurves * kKnots).setZero();
  return out.normalized();
}

Fingerprint fingerprint(const Vector& at_size) {
  Fingerprint f;
  f.about = Vector::Zero(1), f.base = Vector::Zero(at_size.size());
  f.first = at_size, f.second = Matrix::Zero(at_size.size(), 1);
  f.moved_first = Matrix::Zero(5, 1), f.moved_base = Vector::Zero(5);
  f.experiments = 1000;
  return f;
}

// Two effects, one that looks much like both of them at once, and one that has nothing to do with
// them; all of ten deviations at their sizes.
class ModelSelectionTest : public testing::Test {
 protected:
  static constexpr int kFirst = 0, kSecond = 1, kBoth = 2, kOther = 3;

  ModelSelectionTest() {
    first_ = 10 * direction(11), second_ = 10 * direction(12);
    both_ = 10 * (first_ + second_ + 5 * direction(13)).normalized();
    other_ = 10 * direction(14);
    Matrix nulls(kNulls, first_.size());
    for (int i = 0; i < kNulls; ++i) nulls.row(i) = noise(1, i).transpose();
    std::vector<Effect> effects;
    std::vector<Fingerprint> fingerprints;
    for (const auto& [name, vector] :
         {std::pair("first", first_), {"second", second_}, {"both", both_}, {"other", other_}}) {
      Effect e;
      e.name = name, e.paths = {std::string("forces.") + name + ".strength"}, e.sizes = {1};
      effects.push_back(e), fingerprints.push_back(fingerprint(vector));
    }
    selection_ = std::make_unique<ModelSelection>(nulls, Matrix(), effects, fingerprints, kCurves,
                                                  kFalseAlarms);
  }

  std::vector<int> said(const Vector& residual) const {
    std::vector<int> out;
    for (const EffectFit& f : selection_->select(residual).found) out.push_back(f.effect);
    std::sort(out.begin(), out.end());
    return out;
  }

  // Of the second effect, at which this share of null experiments exceeds its z.
  double size_with_chance(double chance) const {
    double low = 0, high = 2;
    for (int i = 0; i < 50; ++i) {
      const double size = 0.5 * (low + high);
      const EffectFit strongest = selection_->effects(size * second_)[0];
      (1 - selection_->confidence(strongest) > chance ? low : high) = size;
    }
    return high;
  }

  Vector first_, second_, both_, other_;
  std::unique_ptr<ModelSelection> selection_;
};

// 1000 complete experiments; a binomial number of mean 20 exceeds 40 once in 50000 times, and the
// threshold itself is known from 400 nulls to a deviation of some 30 %.
TEST_F(ModelSelectionTest, nothingIsSaidOfNothing) {
  int called = 0;
  for (int i = 0; i < 1000; ++i) called += said(noise(2, i)).empty() ? 0 : 1;
  EXPECT_LT(called, 40);
}

TEST_F(ModelSelectionTest, oneEffectIsNamedAloneAndMeasured) {
  for (int i = 0; i < 50; ++i) {
    const SelectedModel e = selection_->select(noise(3, i) + 1.5 * second_);
    ASSERT_EQ(e.found.size(), 1u) << i;
    EXPECT_EQ(e.found[0].effect, kSecond);
    // Ten deviations tell the amplitude to a tenth, and nulls are whitened with an error.
    EXPECT_NEAR(e.found[0].amplitudes(0), 1.5, 0.5);
  }
}

// A z that 3 of 1000 null experiments exceed is significant alone, but not beside another effect.
TEST_F(ModelSelectionTest, aSecondNameNeedsMoreEvidenceThanTheFirst) {
  const Vector weak = size_with_chance(0.003) * second_, strong = size_with_chance(1e-5) * second_;
  EXPECT_EQ(said(weak), (std::vector<int>{kSecond}));
  EXPECT_EQ(said(2 * other_ + weak), (std::vector<int>{kOther}));
  EXPECT_EQ(said(2 * other_ + strong), (std::vector<int>{kSecond, kOther}));
}

// An effect that looks like two others at once is the first choice, and not kept.
TEST_F(ModelSelectionTest, twoEffectsAreNotTakenForOneThatLooksLikeBoth) {
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(said(noise(4, i) + 2 * first_ + 2 * second_), (std::vector<int>{kFirst, kSecond}))
        << i;
  }
}

TEST_F(ModelSelectionTest, oneEffectThatExplainsAllIsNotTakenForTwo) {
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(said(noise(5, i) + 3 * both_), (std::vector<int>{kBoth})) << i;
  }
}

// Effects at once may do what neither does alone: without its simulation a third name stands for
// it, with it none does.
TEST_F(ModelSelectionTest, whatEffectsDoToEachOtherIsNoThirdEffect) {
  const Vector meeting = 0.8 * other_;
  std::vector<EffectFit> pair(2);
  pair[0].effect = kFirst, pair[1].effect = kSecond;
  for (EffectFit& f : pair) f.amplitudes = Vector::Constant(1, 2.0);
  const Vector truth = 2 * first_ + 2 * second_ + meeting;
  const Vector data = noise(6, 0) + truth;
  EXPECT_EQ(said(data), (std::vector<int>{kFirst, kSecond, kOther}));
  selection_->add_interaction(pair, truth, 1000);
  EXPECT_EQ(said(data), (std::vector<int>{kFirst, kSecond}));
}

// Experiments with an effect may scatter as another effect would move them: then that is no
// finding.
TEST_F(ModelSelectionTest, theScatterOfAnEffectIsNoSecondEffect) {
  Matrix scatter(10, first_.size());
  for (int i = 0; i < 10; ++i) {
    scatter.row(i) = (noise(7, i) + normal(8, i, 0) * other_).transpose();
  }
  const Vector data = noise(9, 0) + 4 * first_ + 0.8 * other_;
  EXPECT_EQ(said(data), (std::vector<int>{kFirst, kOther}));
  selection_->inflate_by_scatter(scatter);
  EXPECT_EQ(said(data), (std::vector<int>{kFirst}));
}

TEST_F(ModelSelectionTest, rivalsComeAfterTheMemberWhoseTheyAre) {
  const Vector data = noise(10, 0) + 2 * both_ + 2 * other_;
  const std::vector<EffectFit> rivals =
      selection_->rivals(data, selection_->select(data).found, 0.3, 2);
  ASSERT_EQ(rivals.size(), 3u);  // `both` has one, `other` none
  std::vector<int> effects;
  for (const EffectFit& f : rivals) effects.push_back(f.effect);
  const auto both = std::find(effects.begin(), effects.end(), kBoth);
  ASSERT_NE(both, effects.end());
  ASSERT_NE(both + 1, effects.end());
  EXPECT_TRUE(both[1] == kFirst || both[1] == kSecond);
}

// What no fingerprint is like: a name may come nearest, but it explains nothing.
TEST_F(ModelSelectionTest, aNameThatLeavesMostIsNoExplanation) {
  const Vector odd = 40 * direction(21) + 12 * direction(11);
  const SelectedModel e = selection_->select(noise(11, 0) + odd);
  ASSERT_FALSE(e.found.empty());
  EXPECT_TRUE(selection_->fails(e));
  EXPECT_FALSE(selection_->fails(selection_->select(noise(11, 0) + 3 * first_)));
  EXPECT_FALSE(selection_->fails(selection_->select(noise(11, 0))));
}

// Numbers of curves count for a name as well: an effect that shows in them only is found.
TEST_F(ModelSelectionTest, anEffectThatShowsInCurvesOnlyIsFound) {
  Vector torque = Vector::Zero(first_.size());
  for (int k = 0; k < kCurves * kKnots; ++k) torque(kNamed + k) = k % 2 == 0 ? 3 : -3;
  Effect e;
  e.name = "turning", e.paths = {"forces.turning.strength"}, e.sizes = {1};
  Matrix nulls(kNulls, first_.size());
  for (int i = 0; i < kNulls; ++i) nulls.row(i) = noise(1, i).transpose();
  const ModelSelection selection(nulls, Matrix(), {e}, {fingerprint(torque)}, kCurves,
                                 kFalseAlarms);
  const SelectedModel said = selection.select(noise(12, 0) + torque);
  ASSERT_EQ(said.found.size(), 1u);
  EXPECT_EQ(said.found[0].effect, 0);
}

// By the scatter of its own experiments what scatters widely explains anything, and pays for it.
TEST_F(ModelSelectionTest, aloneTheEffectThatIsThereIsLikelierThanOneThatScattersWidely) {
  const Vector data = noise(13, 0) + 2 * first_;
  double deviance[2];
  for (const bool wide : {false, true}) {
    Fingerprint f = fingerprint(wide ? other_ : first_);
    f.about = Vector::Constant(1, 1.8), f.base = 1.8 * f.first;
    f.scatter.resize(10, first_.size());
    for (int i = 0; i < 10; ++i) f.scatter.row(i) = (wide ? 8 : 1) * noise(14, i).transpose();
    EffectFit fit;
    fit.effect = wide ? kOther : kFirst;
    selection_->set_fingerprint(fit, f);
    const SingleFit alone = selection_->fit_alone(data, fit.effect, -1);
    EXPECT_TRUE(wide || std::fabs(alone.amplitudes(0) - 2) < 0.5);
    deviance[wide ? 1 : 0] = alone.penalized_deviance;
  }
  EXPECT_LT(deviance[0], deviance[1]);
}

TEST_F(ModelSelectionTest, aSearchBegunWithAWrongNameEndsWithTheRightOnes) {
  EffectFit begun;
  begun.effect = kBoth, begun.amplitudes = Vector::Constant(1, 1.0);
  const SelectedModel e = selection_->select(noise(4, 0) + 2 * first_ + 2 * second_, {begun});
  std::vector<int> found;
  for (const EffectFit& f : e.found) found.push_back(f.effect);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<int>{kFirst, kSecond}));
}

TEST_F(ModelSelectionTest, expectedDeviationsAreTheFingerprintsLength) {
  EXPECT_NEAR(selection_->expected_z(kOther, Vector::Constant(1, 2.0)), 20, 4);
}

TEST_F(ModelSelectionTest, nothingIsRefutedByWhatIsThere) {
  EXPECT_LT(selection_->baseline_misfit(noise(4, 3)), selection_->misfit_threshold());
  EXPECT_GT(selection_->baseline_misfit(noise(4, 3) + 2 * other_), selection_->misfit_threshold());
}

// Eight experiments are noisy: their mean alone would be 60 / 8 too long in its square, of which
// nothing may be left.
TEST_F(ModelSelectionTest, expectedDeviationsOfAMeanAreThoseWithoutItsNoise) {
  const auto mean = [](const Vector& planted, int first) {
    Vector sum = Vector::Zero(planted.size());
    for (int i = 0; i < 8; ++i) sum += (planted + noise(4, first + i)) / 8;
    return sum;
  };
  EXPECT_NEAR(selection_->expected_z(kOther, mean(2 * other_, 0), 8), 20, 4);
  EXPECT_LT(selection_->expected_z(kOther, mean(0 * other_, 8), 8), 3);
}

// Of 400 experiments with an effect of the smallest size that would be seen, half show it, with a
// deviation of 10; the threshold is met by an estimate whose mean it is to a tenth. By a
// fingerprint of five experiments more is needed, and one that begins slowly needs the root of its
// size.
// A name is as sure as no null's strongest of all names is as strong.
TEST(ExtremeLaw, sharesOfTheLargestOfManyNormals) {
  std::vector<double> largest;
  const int draws = 2000, each = 50;
  for (int i = 0; i < draws; ++i) {
    double most = -9;
    for (int k = 0; k < each; k += 2) {
      const auto [x, y] = normal_pair({5, Stream::calibrate, i, static_cast<std::uint32_t>(k), 0});
      most = std::max({most, x, y});
    }
    largest.push_back(most);
  }
  const ExtremeLaw law(largest);
  for (const double p : {0.5, 0.1, 0.01}) {
    EXPECT_NEAR(law.chance_beyond(law.exceeded_with(p)), p, 1e-12);
    const double beyond = static_cast<double>(std::count_if(
        largest.begin(), largest.end(), [&](double v) { return v > law.exceeded_with(p); }));
    // Five standard errors, and a third for what is not a Gumbel law at 50 normals.
    EXPECT_NEAR(beyond / draws, p, 5 * std::sqrt(p * (1 - p) / draws) + p / 3) << p;
  }
  EXPECT_EQ(ExtremeLaw({1, 1, 1}).chance_beyond(2), 0);
}

TEST_F(ModelSelectionTest, halfOfAllExperimentsShowTheSmallestSize) {
  Matrix nulls(kNulls, first_.size());
  for (int i = 0; i < kNulls; ++i) nulls.row(i) = noise(1, i).transpose();
  Effect effect;
  effect.name = "one", effect.paths = {"forces.one.strength"}, effect.sizes = {1};
  const auto selection = [&](const Fingerprint& f) {
    return ModelSelection(nulls, Matrix(), {effect}, {f}, kCurves, kFalseAlarms);
  };
  const auto shown = [&](const ModelSelection& of, double size) {
    int count = 0;
    for (int i = 0; i < 400; ++i) {
      count += of.effects(noise(9, i) + size * first_)[0].z > of.effect_threshold() ? 1 : 0;
    }
    return count;
  };
  const ModelSelection sharp = selection(fingerprint(first_));
  EXPECT_NEAR(shown(sharp, sharp.smallest_detectable(0)), 200, 70);
  Fingerprint blurred = fingerprint(first_);
  blurred.first += noise(10, 0) / std::sqrt(5 * kLearnedSquare), blurred.experiments = 5;
  const ModelSelection blunt = selection(blurred);
  EXPECT_GT(blunt.smallest_detectable(0), sharp.smallest_detectable(0));
  EXPECT_NEAR(shown(blunt, blunt.smallest_detectable(0)), 200, 70);
  Fingerprint slow = fingerprint(first_);
  slow.growth = 2;
  EXPECT_NEAR(selection(slow).smallest_detectable(0), std::sqrt(sharp.smallest_detectable(0)),
              0.03);
  EXPECT_TRUE(std::isinf(selection(fingerprint(0.1 * first_)).smallest_detectable(0)));
}

}  // namespace
}  // namespace lilytank
