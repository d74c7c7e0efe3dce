#include "lilytank/trajectory.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <limits>

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "module.hpp"
#include "views.hpp"

namespace lilytank::python {
namespace {

template <class T>
py::array by_frame(const std::vector<T>& data, const py::object& self) {
  const auto& t = self.cast<const Trajectory&>();
  return view(std::span<const T>(data), {data.empty() ? 0 : t.frames(), t.bodies}, self);
}

/// A column of a run's table. Times are numbers; words are codes with the list of words; all else
/// are counts, -1 where a cell is empty.
struct Column {
  std::string name;
  bool is_number = false, is_word = false;
  std::vector<double> numbers;
  std::vector<std::int32_t> codes;
  std::vector<std::string> words;

  explicit Column(std::string of)
      : name(std::move(of)), is_number(name == "time"), is_word(name == "kind" || name == "rule") {}

  void add(const CsvReader& row, std::size_t column) {
    if (is_number) {
      numbers.push_back(row.number(column));
    } else if (is_word) {
      const std::string word(row.text(column));
      const auto at = std::find(words.begin(), words.end(), word);
      codes.push_back(static_cast<std::int32_t>(at - words.begin()));
      if (at == words.end()) words.push_back(word);
    } else {
      constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
      codes.push_back(row.empty(column) ? -1
                                        : static_cast<std::int32_t>(row.whole(column, -1, most)));
    }
  }

  py::object array() {
    if (is_number) return owned(std::move(numbers));
    py::array values = owned(std::move(codes));
    if (!is_word) return values;
    return py::make_tuple(std::move(values), py::cast(words));
  }
};

std::vector<Column> columns_named(const std::string& head) {
  std::vector<Column> columns;
  for (std::size_t at = 0, end = 0; end < head.size(); at = end + 1) {
    end = std::min(head.find(',', at), head.size());
    columns.emplace_back(head.substr(at, end - at));
  }
  return columns;
}

/// events.csv or metrics.csv of a run: arrays by name, of words a pair of codes and words.
py::dict read_run_table(const std::string& file) {
  const std::string text = read_whole(file);
  const std::string head = text.substr(0, text.find('\n'));
  std::vector<Column> columns = columns_named(head);
  CsvReader rows(whole_lines(text), file, {head});
  while (rows.next()) {
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].add(rows, i);
  }
  py::dict out;
  for (Column& column : columns) out[py::str(column.name)] = column.array();
  return out;
}

}  // namespace

void bind_trajectory(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(Markings, label, last, latched, bonded, complete);
  using Shared = std::shared_ptr<Trajectory>;
  py::class_<Trajectory, Shared>(m, "Trajectory")
      .def_readonly("bodies", &Trajectory::bodies)
      .def_readonly("modules", &Trajectory::modules)
      .def_property_readonly(
          "time",
          [](const py::object& self) { return view(self.cast<const Trajectory&>().time, self); })
      .def_property_readonly(
          "x", [](const py::object& s) { return by_frame(s.cast<const Trajectory&>().x, s); })
      .def_property_readonly(
          "y", [](const py::object& s) { return by_frame(s.cast<const Trajectory&>().y, s); })
      .def_property_readonly(
          "theta",
          [](const py::object& s) { return by_frame(s.cast<const Trajectory&>().theta, s); })
      .def_property_readonly("markings", [](const py::object& s) {
        return by_frame(s.cast<const Trajectory&>().markings, s);
      });
  m.def(
      "read_trajectory",
      [](const std::string& file) { return std::make_shared<Trajectory>(read_trajectory(file)); },
      py::arg("file"), py::call_guard<py::gil_scoped_release>());
  m.def("read_run_table", &read_run_table, py::arg("file"));
}

}  // namespace lilytank::python
