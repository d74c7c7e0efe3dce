// Reports as Python objects.
#pragma once
#include <pybind11/pybind11.h>

#include "lilytank/report.hpp"

namespace lilytank::python {

/// A report as a dict of its texts and tables, from which lilytank.Report is made.
pybind11::dict report_dict(const ReportDocument& report);

}  // namespace lilytank::python
