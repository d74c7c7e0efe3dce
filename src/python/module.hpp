// The Python module lilytank._core. Each function below binds one subject; the package beside this
// folder's sources, lilytank/*.py, is what users see.
#pragma once
#include <pybind11/pybind11.h>

#include <vector>

namespace lilytank::python {

namespace py = pybind11;

void bind_scenario(py::module_& m);
void bind_trajectory(py::module_& m);
void bind_run(py::module_& m);
void bind_world(py::module_& m);
void bind_recording(py::module_& m);
void bind_verb(py::module_& m);

}  // namespace lilytank::python
