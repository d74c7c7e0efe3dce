#include "report_dict.hpp"

#include <pybind11/stl.h>

namespace lilytank::python {

namespace py = pybind11;

py::dict report_dict(const ReportDocument& report) {
  using namespace py::literals;
  constexpr const char* tones[] = {"neutral", "good", "finding", "fault"};
  py::list sections;
  for (const ReportSection& s : report.sections) {
    sections.append(py::dict("title"_a = s.title, "above"_a = s.above, "head"_a = s.table.head,
                             "rows"_a = s.table.rows, "below"_a = s.below));
  }
  return py::dict("title"_a = report.title, "subtitle"_a = report.subtitle,
                  "tone"_a = tones[static_cast<std::size_t>(report.card.tone)],
                  "verdict"_a = report.card.verdict, "facts"_a = report.card.facts,
                  "sections"_a = sections, "warnings"_a = report.warnings,
                  "inputs"_a = report.provenance.inputs, "command"_a = report.provenance.command,
                  "text"_a = report_text(report));
}

}  // namespace lilytank::python
