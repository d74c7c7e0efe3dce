// NetCDF-4 files: the only user of the NetCDF library.
#include "lilytank/data_file.hpp"
#include "lilytank/error.hpp"
#ifdef LILYTANK_HAS_NETCDF
#include <netcdf.h>
#include <netcdf_mem.h>

#include <cstdlib>
#endif

namespace lilytank {

#ifdef LILYTANK_HAS_NETCDF

namespace {

constexpr int kDeflate = 4;  // higher levels gain 1 % on poses and take twice the time

/// A file in memory, closed whatever happens.
class NetcdfFile {
 public:
  NetcdfFile() { check(nc_create_mem("results.nc", NC_NETCDF4, 0, &id_)); }
  ~NetcdfFile() {
    if (id_ >= 0) nc_close(id_);
  }
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  /// Closes the file; its bytes.
  std::string close() {
    NC_memio memory{};
    const int id = id_;
    id_ = -1;
    check(nc_close_memio(id, &memory));
    std::string out(static_cast<const char*>(memory.memory), memory.size);
    std::free(memory.memory);
    return out;
  }
  void put(const DataAttributes& attributes) { put_attributes(id_, NC_GLOBAL, attributes); }
  void put(const DataGroup& group) {
    int id = 0;
    check(nc_def_grp(id_, group.name.c_str(), &id));
    for (const auto& [name, length] : group.dimensions) {
      int dimension = 0;  // a length of 0 would be unlimited
      check(nc_def_dim(id, name.c_str(), length, &dimension));
    }
    for (const DataVariable& variable : group.variables) put_variable(id, group, variable);
  }

 private:
  static void check(int status) {
    if (status != NC_NOERR)
      throw InputError(std::string("the NetCDF library failed: ") + nc_strerror(status));
  }
  void put_attributes(int group, int variable, const DataAttributes& attributes) const {
    for (const auto& [name, text] : attributes)
      check(nc_put_att_text(group, variable, name.c_str(), text.size(), text.c_str()));
  }

  static int type_of(const std::vector<double>&) { return NC_DOUBLE; }
  static int type_of(const std::vector<float>&) { return NC_FLOAT; }
  static int type_of(const std::vector<std::int64_t>&) { return NC_INT64; }
  static int type_of(const std::vector<std::int16_t>&) { return NC_SHORT; }
  static int type_of(const std::vector<std::int8_t>&) { return NC_BYTE; }
  static int type_of(const std::vector<std::string>&) { return NC_STRING; }

  // With explicit lengths: a table without rows has an unlimited dimension.
  template <class T>
  void put_values(int group, int id, const std::vector<std::size_t>& count,
                  const std::vector<T>& values) const {
    const std::vector<std::size_t> start(count.size(), 0);
    check(nc_put_vara(group, id, start.data(), count.data(), values.data()));
  }
  void put_values(int group, int id, const std::vector<std::size_t>& count,
                  const std::vector<std::string>& values) const {
    std::vector<const char*> texts;
    for (const std::string& text : values) texts.push_back(text.c_str());
    const std::vector<std::size_t> start(count.size(), 0);
    check(nc_put_vara_string(group, id, start.data(), count.data(), texts.data()));
  }

  void put_variable(int group, const DataGroup& of, const DataVariable& variable) const {
    std::vector<int> dimensions;
    std::vector<std::size_t> count;
    for (const std::string& name : variable.dimensions) {
      check(nc_inq_dimid(group, name.c_str(), &dimensions.emplace_back()));
      for (const auto& [known, length] : of.dimensions) {
        if (known == name) count.push_back(length);
      }
    }
    std::visit(
        [&](const auto& values) {
          int id = 0;
          check(nc_def_var(group, variable.name.c_str(), type_of(values),
                           static_cast<int>(dimensions.size()), dimensions.data(), &id));
          if (type_of(values) != NC_STRING) check(nc_def_var_deflate(group, id, 1, 1, kDeflate));
          put_attributes(group, id, variable.attributes);
          if (!values.empty()) put_values(group, id, count, values);
        },
        variable.values);
  }

  int id_ = -1;
};

}  // namespace

std::string netcdf(const DataFile& data) {
  NetcdfFile out;
  out.put(data.attributes);
  for (const DataGroup& group : data.groups) out.put(group);
  return out.close();
}

#else

std::string netcdf(const DataFile&) {
  throw InputError("this program was built without NetCDF (Debian: libnetcdf-dev)");
}

#endif

}  // namespace lilytank
