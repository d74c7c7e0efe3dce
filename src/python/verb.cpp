// The verbs of the command line as functions.
#include <pybind11/stl.h>

#include <iostream>
#include <mutex>
#include <sstream>

#include "cli/command.hpp"
#include "cli/host.hpp"
#include "cli/printable_stream.hpp"
#include "job.hpp"
#include "module.hpp"
#include "refusals.hpp"
#include "report_dict.hpp"

namespace lilytank::python {
namespace {

using namespace py::literals;

/// What a stream gets while this exists.
class Captured {
 public:
  explicit Captured(std::ostream& stream)
      : stream_(&stream), before_(stream.rdbuf(text_.rdbuf())) {}
  ~Captured() { stream_->rdbuf(before_); }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream* stream_;
  std::streambuf* before_;
};

/// What a verb printed and reported.
struct Outcome {
  int code = 0;
  std::string out, err;
  std::vector<ReportDocument> reports;
};

/// Verbs print to the process's streams, so there is one at a time.
Outcome do_verb(const cli::Arguments& words, const JobControl& control) {
  static std::mutex one;
  const std::lock_guard hold(one);
  Outcome outcome;
  const cli::Host host{control.stop,
                       [&](double done, const std::string& note) { control.report(done, note); },
                       [&](const ReportDocument& report) { outcome.reports.push_back(report); }};
  const Captured out(std::cout), err(std::cerr);
  const cli::PrintableStream printable_out(std::cout, false), printable_err(std::cerr, false);
  const std::vector<std::string> rest(words.begin() + 1, words.end());
  outcome.code = with_command(words[0], rest, [&] { return cli::act(words, host); });
  outcome.out = out.text(), outcome.err = err.text();
  if (outcome.code == cli::Exit::bad_input) throw InputError(outcome.err);
  return outcome;
}

py::dict verb(const std::vector<std::string>& words, const py::object& progress) {
  if (words.empty()) throw InputError("which verb? 'lilytank help' lists what there is");
  Outcome outcome;
  run_job(progress, [&](const JobControl& control) { outcome = do_verb(words, control); });
  py::list reports;
  for (const ReportDocument& report : outcome.reports) reports.append(report_dict(report));
  return py::dict("code"_a = outcome.code, "out"_a = outcome.out, "err"_a = outcome.err,
                  "reports"_a = reports);
}

}  // namespace

void bind_verb(py::module_& m) {
  m.def("verb", &verb, py::arg("words"), py::arg("progress"));
}

}  // namespace lilytank::python
