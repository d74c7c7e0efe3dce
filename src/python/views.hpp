// Data of the library as NumPy arrays without a copy.
#pragma once
#include <pybind11/numpy.h>

#include <span>
#include <utility>
#include <vector>

namespace lilytank::python {

/// A read-only array of `data`, which belongs to `owner`: the array keeps that alive.
template <class T>
pybind11::array view(std::span<const T> data, std::vector<pybind11::ssize_t> shape,
                     pybind11::handle owner) {
  namespace py = pybind11;
  py::array out(py::dtype::of<T>(), std::move(shape), {}, data.data(), owner);
  py::detail::array_proxy(out.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return out;
}

template <class T>
pybind11::array view(std::span<const T> data, pybind11::handle owner) {
  return view(data, {static_cast<pybind11::ssize_t>(data.size())}, owner);
}

template <class T>
pybind11::array view(const std::vector<T>& data, pybind11::handle owner) {
  return view(std::span<const T>(data), owner);
}

/// An array that takes over the values.
template <class T>
pybind11::array owned(std::vector<T> values) {
  namespace py = pybind11;
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  const std::vector<T>& data = *kept;
  const py::capsule owner(kept.release(), [](void* v) { delete static_cast<std::vector<T>*>(v); });
  return view(data, owner);
}

}  // namespace lilytank::python
