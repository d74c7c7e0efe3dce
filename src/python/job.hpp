// Jobs of the library under Python: without the interpreter's lock, with progress and Ctrl-C.
#pragma once
#include <pybind11/pybind11.h>

#include <functional>

#include "lilytank/job_control.hpp"

namespace lilytank::python {

/// Calls work(control) on a thread of its own. Meanwhile this thread, which holds the interpreter's
/// lock when it calls, handles Python's signals, calls progress(done, note) unless it is None, and
/// calls `check` if that is given. An exception of these stops the job and is thrown once it has
/// ended.
void run_job(const pybind11::object& progress,
             const std::function<void(const JobControl& control)>& work,
             const std::function<void()>& check = {});

}  // namespace lilytank::python
