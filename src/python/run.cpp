#include "lilytank/run.hpp"

#include <pybind11/stl.h>

#include "force.hpp"
#include "job.hpp"
#include "jobs/report.hpp"
#include "lilytank/trajectory.hpp"
#include "module.hpp"
#include "refusals.hpp"
#include "report_dict.hpp"

namespace lilytank::python {
namespace {

using namespace py::literals;

py::dict as_dict(const RunResult& r, const Model& model) {
  const bool diverged = r.status == RunStatus::diverged;
  return py::dict("diverged"_a = diverged,
                  "divergence"_a = diverged ? divergence_text(r.divergence, model) : "",
                  "time"_a = r.time, "wall"_a = r.wall, "fingerprint"_a = hex(r.fingerprint),
                  "copies"_a = r.copies, "possible"_a = r.possible,
                  "completion_times"_a = r.completion_times, "illegal"_a = r.illegal,
                  "resumed"_a = r.resumed, "already_complete"_a = r.already_complete);
}

py::dict run_scenario(const Scenario& scenario, const std::vector<std::string>& files,
                      const std::string& out, bool force,
                      const std::vector<py::function>& functions, const py::object& progress) {
  const ExtendedScenario extended(scenario, functions, false);
  RunOptions options;
  options.out = out, options.force = force;
  RunResult result;
  run_job(
      progress,
      [&](const JobControl& control) {
        static_cast<JobControl&>(options) = control;
        with_command("run", files, [&] { result = run(extended.scenario(), options); });
      },
      [&] { extended.check(); });
  extended.check();
  return as_dict(result, extended.scenario().model);
}

py::dict stored_run(const std::string& dir) {
  auto run = std::make_shared<StoredRun>();
  {
    const py::gil_scoped_release release;
    *run = load_run(dir);
  }
  const std::shared_ptr<Trajectory> trajectory(run, &run->trajectory);
  const std::shared_ptr<Scenario> scenario(run, &run->scenario);
  return py::dict("scenario"_a = scenario, "trajectory"_a = trajectory);
}

py::dict report_of(const Scenario& scenario, const std::string& dir) {
  return report_dict(run_report({scenario, {}, {}, {}}, dir));
}

}  // namespace

void bind_run(py::module_& m) {
  m.def("run", &run_scenario, py::arg("scenario"), py::arg("files"), py::arg("out"),
        py::arg("force"), py::arg("forces"), py::arg("progress"));
  m.def("run_report", &report_of, py::arg("scenario"), py::arg("dir"));
  m.def("load_run", &stored_run, py::arg("dir"));
}

}  // namespace lilytank::python
