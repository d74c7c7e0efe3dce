#include "force.hpp"

#include <pybind11/numpy.h>

#include <optional>

#include "module.hpp"

namespace lilytank::python {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A copy: the function may keep it.
py::array_t<double> copied(std::span<const double> values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::object bodies_of(const Kinematics& k) {
  const py::object type = py::module_::import("types").attr("SimpleNamespace");
  using namespace py::literals;
  return type("x"_a = copied(k.x), "y"_a = copied(k.y), "cos"_a = copied(k.c),
              "sin"_a = copied(k.s), "vx"_a = copied(k.vx), "vy"_a = copied(k.vy),
              "omega"_a = copied(k.omega), "modules"_a = k.modules);
}

/// One component for every body: a number, or an array of one value each.
class Component {
 public:
  Component(const py::object& value, std::size_t bodies) : values_(value) {
    const auto size = static_cast<std::size_t>(values_.size());
    if (size != 1 && size != bodies) {
      throw py::value_error("a force returned " + std::to_string(size) + " values for " +
                            std::to_string(bodies) + " bodies");
    }
    step_ = size == 1 ? 0 : 1;
  }
  double operator[](std::size_t body) const { return values_.data()[body * step_]; }

 private:
  Array values_;
  std::size_t step_ = 0;
};

void add_components(const py::object& returned, std::span<Wrench> out) {
  if (!py::isinstance<py::tuple>(returned) || py::len(returned) < 2 || py::len(returned) > 3) {
    throw py::type_error("a force returns (fx, fy) or (fx, fy, torque), or None");
  }
  const py::tuple parts(returned);
  const Component fx(parts[0], out.size()), fy(parts[1], out.size());
  std::optional<Component> torque;
  if (parts.size() == 3) torque.emplace(parts[2], out.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].fx += fx[i], out[i].fy += fy[i];
    if (torque) out[i].torque += (*torque)[i];
  }
}

}  // namespace

/// Calls a function of the user's.
class ExtendedScenario::Function final : public ForceTerm {
 public:
  Function(ExtendedScenario& owner, py::function f)
      : owner_(&owner), f_(std::move(f)), name_(py::str(f_.attr("__name__"))) {}
  std::string_view name() const override { return name_; }
  std::string_view summary() const override { return "a function in Python"; }
  std::string_view equation() const override { return ""; }
  std::span<const Parameter> parameters() const override { return {}; }
  void add(const Model&, const Kinematics& k, const StepContext& now, std::span<const double>,
           std::span<Wrench> out) const override {
    if (owner_->failed()) return;
    const py::gil_scoped_acquire lock;
    try {
      const py::object returned = f_(now.time, bodies_of(k));
      if (!returned.is_none()) add_components(returned, out);
    } catch (...) {
      owner_->failure_ = std::current_exception();
    }
  }

 private:
  ExtendedScenario* owner_;
  py::function f_;
  std::string name_;
};

/// Adds the array that the user fills between steps.
class ExtendedScenario::Applied final : public ForceTerm {
 public:
  explicit Applied(const ExtendedScenario& owner) : owner_(&owner) {}
  std::string_view name() const override { return "applied"; }
  std::string_view summary() const override { return "wrenches set between steps"; }
  std::string_view equation() const override { return ""; }
  std::span<const Parameter> parameters() const override { return {}; }
  void add(const Model&, const Kinematics&, const StepContext&, std::span<const double>,
           std::span<Wrench> out) const override {
    const double* w = owner_->applied_.data();
    for (std::size_t i = 0; i < out.size(); ++i, w += 3) {
      out[i].fx += w[0], out[i].fy += w[1], out[i].torque += w[2];
    }
  }

 private:
  const ExtendedScenario* owner_;
};

ExtendedScenario::ExtendedScenario(const Scenario& scenario,
                                   const std::vector<py::function>& functions, bool applies)
    : scenario_(scenario) {
  for (const py::function& f : functions) terms_.push_back(std::make_unique<Function>(*this, f));
  if (applies) {
    applied_.resize(3 * static_cast<std::size_t>(scenario.model.bodies()));
    terms_.push_back(std::make_unique<Applied>(*this));
  }
  for (const auto& term : terms_) scenario_.model.forces.push_back({term.get(), {}});
}

ExtendedScenario::~ExtendedScenario() = default;

bool ExtendedScenario::failed() const {
  return failure_ != nullptr;
}

void ExtendedScenario::check() const {
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace lilytank::python
