#include "table.hpp"

#include <cstdio>

namespace lilytank::bench {
namespace {

double counter(const benchmark::BenchmarkReporter::Run& run, const char* name) {
  const auto found = run.counters.find(name);
  return found == run.counters.end() ? 0 : found->second.value;
}

}  // namespace

void TableReporter::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    const std::string& name = run.run_name.function_name;
    if (run.error_occurred) {
      std::printf("%s: ERROR OCCURRED: %s\n", name.c_str(), run.error_message.c_str());
    } else if (name.rfind("world/", 0) == 0) {
      world_row(run);
    } else {
      contest_row(run);
    }
  }
  std::fflush(stdout);
}

void TableReporter::world_row(const Run& run) {
  if (!worlds_begun_) {
    std::printf(
        "| %-26s | modules | ns/module-step | least | x real time | kB/world | "
        "allocations | fingerprint      |\n"
        "|----------------------------|--------:|---------------:|------:|------------:|"
        "---------:|------------:|------------------|\n",
        "world");
    worlds_begun_ = true;
  }
  std::printf("| %-26s | %7.0f | %14.1f | %5.0f | %11.0f | %8.1f | %11.0f | %s |\n",
              run.run_name.function_name.c_str() + 6, counter(run, "modules"), counter(run, "ns"),
              counter(run, "least_ns"), counter(run, "x_real_time"),
              counter(run, "heap_bytes") / 1e3, counter(run, "allocations"),
              run.report_label.c_str());
}

void TableReporter::contest_row(const Run& run) {
  if (!contests_begun_) {
    std::printf(
        "\n| %-29s | modules | engine steps | theirs, ns | ours, ns | theirs/ours | kB theirs | "
        "mm/s theirs, ours | touching theirs, ours | overlap theirs, ours, mm |\n"
        "|-------------------------------|--------:|-------------:|-----------:|---------:|"
        "------------:|----------:|------------------:|----------------------:|--------------------"
        "-----:|\n",
        "engine, forces");
    contests_begun_ = true;
  }
  const std::string& name = run.run_name.function_name;
  const std::string what = name.substr(8, name.rfind('/') - 8);
  std::printf(
      "| %-29s | %7.0f | %12.0f | %10.0f | %8.0f | %11.2f | %9.0f | %8.1f %8.1f | "
      "%10.3f %10.3f | %11.2f %12.2f |\n",
      what.c_str(), counter(run, "modules"), counter(run, "substeps"), counter(run, "peer_ns"),
      counter(run, "ns"), counter(run, "ratio"), counter(run, "peer_heap_bytes") / 1e3,
      counter(run, "peer_mm_per_s"), counter(run, "mm_per_s"), counter(run, "peer_touching"),
      counter(run, "touching"), counter(run, "peer_overlap_um") / 1e3,
      counter(run, "overlap_um") / 1e3);
}

}  // namespace lilytank::bench
