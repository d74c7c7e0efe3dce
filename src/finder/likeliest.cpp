// What is told, judged by the scatter of experiments with what is likeliest.
#include <algorithm>
#include <tuple>

#include "finder/sharpening.hpp"

namespace lilytank {
namespace {

using Vector = Eigen::VectorXd;

constexpr int kMostCentred = 2;
constexpr double kNamesFirst = 30;  // of a doubt
constexpr double kCurveLeft = 0.4;  // of what was found, that a curve may be which is left
constexpr double kLeastOwn = 1;     // z of an effect by the scatter of experiments with it

}  // namespace

std::optional<EffectFit> Diagnoser::Sharpening::likeliest(bool effects_only,
                                                          const std::string& variable) const {
  const auto doubt = [](const auto& one) {
    return one.second.penalized_deviance + (one.first.first < 0 ? kNamesFirst : 0);
  };
  const auto least = [&](const auto& a, const auto& b) { return doubt(a) < doubt(b); };
  std::map<Name, SingleFit> those = alone_;
  if (effects_only) {
    std::erase_if(those, [](const auto& one) { return one.first.first < 0; });
  }
  std::erase_if(those, [&](const auto& one) {
    const int name = one.first.first;
    if (variable.empty() || name < 0) return false;
    return of_.atlas_->plan().effects[static_cast<std::size_t>(name)].variable != variable;
  });
  const auto likely = std::min_element(those.begin(), those.end(), least);
  if (likely == those.end()) return std::nullopt;
  EffectFit out;
  std::tie(out.effect, out.shape) = likely->first;
  out.amplitudes = likely->second.amplitudes;
  return out;
}

SelectedModel Diagnoser::Sharpening::explained() {
  for (int pass = 0; pass < kMostCentred; ++pass) {
    bool moved = false;
    for (const bool effects_only : {false, true}) {
      const std::optional<EffectFit> likely = likeliest(effects_only);
      if (!likely || !off_centre(*likely, kBeside)) continue;
      sharpen(*likely, known_.at(name_of(*likely)).experiments), moved = true;
    }
    if (!moved) break;
  }
  const std::optional<EffectFit> likely = likeliest();
  if (likely) selection_.inflate_by_scatter(known_[name_of(*likely)].scatter);
  return explained_by(selection_);
}

SelectedModel Diagnoser::Sharpening::explained_by(const ModelSelection& selection) const {
  const std::optional<EffectFit> likely = likeliest();
  SelectedModel e = selection.select(residual_);
  if (e.found.empty() && likely && nothing_ > selection.misfit_threshold()) {
    return something(selection, likeliest(true).value_or(*likely));
  }
  if (!likely || likely->shape >= 0 || is_found(*likely, e)) return e;
  SelectedModel other = selection.select(residual_, {*likely});
  if (leaves_curve(selection, other) && !selection.leaves_residual(e)) return e;
  return other.penalized_deviance < e.penalized_deviance ? other : e;
}

SelectedModel Diagnoser::Sharpening::something(const ModelSelection& selection,
                                               const EffectFit& likely) const {
  SelectedModel e = selection.select(residual_, {likely});
  if (e.found.empty() || e.found[0].z < kLeastOwn) {
    e.found.clear(), e.misfit = nothing_, e.share_left = 1;
  }
  return e;
}

bool Diagnoser::Sharpening::leaves_curve(const ModelSelection& selection,
                                         const SelectedModel& e) const {
  double largest = 0;
  for (const EffectFit& f : e.found) largest = std::max(largest, f.z);
  return e.left_shape.z > std::max(selection.shape_threshold(), kCurveLeft * largest);
}

bool Diagnoser::Sharpening::is_found(const EffectFit& f, const SelectedModel& e) const {
  return std::any_of(e.found.begin(), e.found.end(),
                     [&](const EffectFit& other) { return name_of(other) == name_of(f); });
}

}  // namespace lilytank
