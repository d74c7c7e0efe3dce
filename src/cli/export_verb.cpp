// lilytank export: stored results for other programs.
#include <filesystem>
#include <iostream>

#include "cli/options.hpp"
#include "io/atomic_file.hpp"
#include "lilytank/data_file.hpp"

namespace lilytank::cli {

int export_verb(const Arguments& arguments, const Host&) {
  VerbOptions options(
      "export", "DIR",
      "Writes the results in a directory (of a run, study, analysis, ...) for other "
      "programs: tables and poses as NetCDF-4, or their provenance as an RO-Crate.");
  std::string format = "netcdf";
  bool force = false, quiet = false;
  options.add({"format", "netcdf or ro-crate (default: netcdf)", "FORMAT"}, &format,
              {"netcdf", "ro-crate"});
  options.add({"out", "of netcdf: the file (default: DIR/results.nc)", "FILE"});
  options.add({"license", "of ro-crate: license of the data, an address", "URL"});
  options.add({"force", "replace the file"}, &force);
  options.add({"quiet", "print nothing"}, &quiet);
  const std::string none = "no directory of results";
  if (!options.parse(arguments, none)) return Exit::done;
  const std::string& dir = options.only("one directory of results at a time");
  const bool crate = format == "ro-crate";
  if (crate)
    options.refuse_given({"out"}, "goes with --format netcdf; an RO-Crate lies in DIR");
  else
    options.refuse_given({"license"}, "goes with --format ro-crate");
  const std::string file = crate
                               ? (std::filesystem::path(dir) / kCrateFile).string()
                               : options.out((std::filesystem::path(dir) / "results.nc").string());
  const std::string bytes =
      crate ? crate_of_results(dir, options.text("license")) : netcdf(data_of_results(dir));
  write_results({{file, bytes}}, force);
  if (!quiet) std::cout << file << "\n";
  return Exit::done;
}

}  // namespace lilytank::cli
