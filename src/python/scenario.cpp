#include "lilytank/scenario.hpp"

#include <pybind11/stl.h>

#include "cli/inputs.hpp"
#include "module.hpp"
#include "refusals.hpp"

namespace lilytank::python {
namespace {

std::shared_ptr<Scenario> read_scenario(const std::vector<std::string>& files,
                                        const std::vector<std::string>& sets) {
  return with_command("run", files, [&] {
    cli::refuse_point_bodies(files);
    return std::make_shared<Scenario>(load_scenario(files, sets));
  });
}

py::list entries_of(const Scenario& scenario) {
  py::list out;
  for (const ScenarioEntry& e : scenario.entries) {
    out.append(py::make_tuple(e.path, e.value, e.unit, e.bounds, e.meaning, e.is_default,
                              e.is_default ? "" : e.where.text()));
  }
  return out;
}

}  // namespace

void bind_scenario(py::module_& m) {
  py::class_<Scenario, std::shared_ptr<Scenario>>(m, "Scenario")
      .def(py::init(&read_scenario), py::arg("files"), py::arg("sets"))
      .def_readonly("title", &Scenario::title)
      .def_readonly("duration", &Scenario::duration)
      .def_readonly("seed", &Scenario::seed)
      .def_readonly("resolved", &Scenario::resolved)
      .def_property_readonly("identity", [](const Scenario& s) { return hex(s.identity); })
      .def_property_readonly("dt", [](const Scenario& s) { return s.model.dt; })
      .def_property_readonly("modules", [](const Scenario& s) { return s.model.module.count; })
      .def_property_readonly("balls", [](const Scenario& s) { return s.model.ball.count; })
      .def_property_readonly("rules",
                             [](const Scenario& s) {
                               std::vector<std::string> texts;
                               for (const Ruleset& r : s.model.rulesets) {
                                 texts.push_back(to_text(r));
                               }
                               return texts;
                             })
      .def("entries", &entries_of);
}

}  // namespace lilytank::python
