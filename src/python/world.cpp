// Simulations step by step.
#include "lilytank/world.hpp"

#include <pybind11/stl.h>

#include <chrono>
#include <cstring>

#include "force.hpp"
#include "jobs/report.hpp"
#include "lilytank/assembly_record.hpp"
#include "module.hpp"
#include "refusals.hpp"
#include "views.hpp"

namespace lilytank::python {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kBetweenSignals = std::chrono::milliseconds(50);

class PythonWorld {
 public:
  PythonWorld(const Scenario& scenario, const std::vector<std::string>& files, std::uint64_t seed,
              const std::vector<py::function>& functions, bool applies)
      : scenario_(scenario, functions, applies),
        world_(with_command("run", files, [&] { return World(model(), seed); })),
        record_(model()) {
    record_.observe(world_);
  }

  /// Up to `steps` steps; false once it has diverged.
  bool step(std::int64_t steps) {
    events_.clear();
    bool ok = true;
    {
      const py::gil_scoped_release release;
      auto looked = Clock::now();
      for (std::int64_t k = 0; k < steps && ok && !scenario_.failed(); ++k) {
        ok = world_.step() == RunStatus::ok;
        record_.observe(world_);
        events_.insert(events_.end(), world_.events().begin(), world_.events().end());
        if (k % 16 != 15 || Clock::now() - looked < kBetweenSignals) continue;
        looked = Clock::now();
        const py::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      }
    }
    scenario_.check();
    return ok;
  }

  std::string divergence() const {
    const bool diverged = !world_.divergence().force.empty();
    return diverged ? divergence_text(world_.divergence(), model()) : "";
  }

  /// The length of the record's text (8 bytes), this text, and the state.
  py::bytes snapshot() const {
    const std::string record = record_.to_text();
    const std::uint64_t size = record.size();
    std::string out(sizeof size, '\0');
    std::memcpy(out.data(), &size, sizeof size);
    return out + record + to_snapshot(world_.state(), scenario_.scenario().identity);
  }

  void restore(const std::string& bytes) {
    std::uint64_t size = 0;
    if (bytes.size() < sizeof size) throw InputError("snapshot: it is cut");
    std::memcpy(&size, bytes.data(), sizeof size);
    if (size > bytes.size() - sizeof size) throw InputError("snapshot: it is cut");
    const auto at = sizeof size + static_cast<std::size_t>(size);
    State state = from_snapshot(bytes.substr(at), scenario_.scenario().identity, "snapshot");
    World world(model(), std::move(state));
    AssemblyRecord record(model());
    record.restore(bytes.substr(sizeof size, at - sizeof size), world);
    world_.go_on_from(world.state());
    record_ = std::move(record);
    events_.clear();
  }

  const Model& model() const { return scenario_.scenario().model; }
  const World& world() const { return world_; }
  const AssemblyRecord& record() const { return record_; }
  const std::vector<Event>& events() const { return events_; }
  std::vector<double>& applied() { return scenario_.applied(); }

 private:
  ExtendedScenario scenario_;
  World world_;
  AssemblyRecord record_;
  std::vector<Event> events_;
};

/// Adds a property that shows an array of Kinematics.
template <class T>
void kinematic(py::class_<PythonWorld>& type, const char* name,
               std::span<const T> Kinematics::*array) {
  type.def_property_readonly(name, [array](const py::object& self) {
    return view(self.cast<const PythonWorld&>().world().kinematics().*array, self);
  });
}

py::array theta_of(const PythonWorld& world) {
  const Kinematics& k = world.world().kinematics();
  std::vector<double> out;
  for (std::size_t i = 0; i < k.c.size(); ++i) out.push_back(std::atan2(k.s[i], k.c[i]));
  return owned(std::move(out));
}

py::array labels_of(const PythonWorld& world) {
  std::vector<std::int32_t> out;
  for (const Firmware& f : world.world().state().firmware) out.push_back(f.label);
  return owned(std::move(out));
}

/// [modules, 4] The module that each face holds, -1: none.
py::array partners_of(const PythonWorld& world) {
  std::vector<std::int32_t> out;
  for (const Face& f : world.world().state().faces) out.push_back(f.partner);
  const auto modules = static_cast<py::ssize_t>(out.size() / 4);
  return owned(std::move(out)).reshape({modules, py::ssize_t{4}});
}

py::array applied_of(const py::object& self) {
  auto& values = self.cast<PythonWorld&>().applied();
  return py::array(py::dtype::of<double>(),
                   {static_cast<py::ssize_t>(values.size() / 3), py::ssize_t{3}}, {}, values.data(),
                   self);
}

py::list events_of(const PythonWorld& world) {
  constexpr const char* kinds[] = {"latch",  "unlatch", "link",   "unlink",
                                   "update", "report",  "command"};
  py::list out;
  for (const Event& e : world.events()) {
    out.append(py::make_tuple(static_cast<double>(e.step + 1) * world.model().dt,
                              kinds[static_cast<std::size_t>(e.kind)], e.a, e.face_a, e.b, e.face_b,
                              e.rule));
  }
  return out;
}

void bind_numbers(py::class_<PythonWorld>& type) {
  type.def_property_readonly("time", [](const PythonWorld& w) { return w.world().time(); })
      .def_property_readonly("steps", [](const PythonWorld& w) { return w.world().steps(); })
      .def_property_readonly("dt", [](const PythonWorld& w) { return w.model().dt; })
      .def_property_readonly("modules", [](const PythonWorld& w) { return w.model().module.count; })
      .def_property_readonly("bodies", [](const PythonWorld& w) { return w.model().bodies(); })
      .def_property_readonly("copies", [](const PythonWorld& w) { return w.record().copies(); })
      .def_property_readonly("possible",
                             [](const PythonWorld& w) { return w.record().possible_copies(); })
      .def_property_readonly("completion_times",
                             [](const PythonWorld& w) { return w.record().completion_times(); })
      .def_property_readonly("by_size", [](const PythonWorld& w) { return w.record().by_size(); })
      .def_property_readonly("illegal", [](const PythonWorld& w) { return w.record().illegal(); })
      .def_property_readonly("divergence", &PythonWorld::divergence)
      .def_property_readonly(
          "fingerprint", [](const PythonWorld& w) { return hex(fingerprint(w.world().state())); });
}

}  // namespace

void bind_world(py::module_& m) {
  py::class_<PythonWorld> type(m, "World");
  type.def(py::init<const Scenario&, const std::vector<std::string>&, std::uint64_t,
                    const std::vector<py::function>&, bool>(),
           py::arg("scenario"), py::arg("files"), py::arg("seed"), py::arg("forces"),
           py::arg("applies"))
      .def("step", &PythonWorld::step, py::arg("steps"))
      .def("snapshot", &PythonWorld::snapshot)
      .def("restore", [](PythonWorld& w, const py::bytes& bytes) { w.restore(bytes); })
      .def("events", &events_of)
      .def_property_readonly("applied", &applied_of)
      .def_property_readonly("theta", &theta_of)
      .def_property_readonly("labels", &labels_of)
      .def_property_readonly("partners", &partners_of);
  kinematic(type, "x", &Kinematics::x), kinematic(type, "y", &Kinematics::y);
  kinematic(type, "vx", &Kinematics::vx), kinematic(type, "vy", &Kinematics::vy);
  kinematic(type, "omega", &Kinematics::omega);
  kinematic(type, "latched", &Kinematics::covered);
  bind_numbers(type);
}

}  // namespace lilytank::python
