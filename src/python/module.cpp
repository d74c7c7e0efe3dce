#include "module.hpp"

#include "lilytank/error.hpp"
#include "text/printable.hpp"

namespace lilytank::python {
namespace {

/// InputError becomes lilytank.InputError with the line that the program prints.
void translate(std::exception_ptr failure) {
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const InputError& e) {
    const py::object type = py::module_::import("lilytank._core").attr("InputError");
    PyErr_SetString(type.ptr(), printable(e.what()).c_str());
  } catch (const Stopped& e) {
    PyErr_SetString(PyExc_KeyboardInterrupt, e.what());
  }
}

}  // namespace
}  // namespace lilytank::python

PYBIND11_MODULE(_core, m) {
  namespace py = pybind11;
  using namespace lilytank::python;
  m.doc() = "The compiled part of lilytank.";
  m.attr("__version__") = LILYTANK_VERSION;
  const py::exception<lilytank::InputError> error(m, "InputError", PyExc_ValueError);
  error.attr("__module__") = "lilytank";
  error.attr("__doc__") =
      "Input that cannot be used. The text is the line that the command-line program prints: file, "
      "line, column, value and the nearest valid word.";
  py::register_exception_translator(&translate);
  bind_scenario(m);
  bind_trajectory(m);
  bind_run(m);
  bind_world(m);
  bind_recording(m);
  bind_verb(m);
}
