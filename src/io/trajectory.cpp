#include "lilytank/trajectory.hpp"

#include "io/atomic_file.hpp"
#include "io/trajectory_format.hpp"

namespace lilytank {
namespace {

class NoWriter final : public TrajectoryWriter {
 public:
  void write(const World&, const std::vector<std::uint8_t>&) override {}
  FileDigest flush() override { return {}; }
};

}  // namespace

Markings markings_of(const World& world, int module, const std::vector<std::uint8_t>& complete) {
  const State& state = world.state();
  Markings out;
  out.label = static_cast<std::int16_t>(state.firmware[module].label);
  out.last = state.firmware[module].last;
  for (std::size_t f = 0; f < 4; ++f) {
    const FaceStatus status = state.faces[4 * module + f].status;
    const bool bonded = status == FaceStatus::bonded;
    const int bit = 1 << f;
    if (bonded) out.bonded = static_cast<std::uint8_t>(out.bonded | bit);
    if (bonded || status == FaceStatus::latched) {
      out.latched = static_cast<std::uint8_t>(out.latched | bit);
    }
  }
  if (static_cast<std::size_t>(module) < complete.size()) out.complete = complete[module];
  return out;
}

void append_poses(const World& world, Trajectory& trajectory) {
  const Kinematics& k = world.kinematics();
  trajectory.bodies = k.size();
  trajectory.modules = k.modules;
  trajectory.time.push_back(world.time());
  for (int i = 0; i < k.size(); ++i) {
    trajectory.x.push_back(static_cast<float>(k.x[i]));
    trajectory.y.push_back(static_cast<float>(k.y[i]));
    trajectory.theta.push_back(static_cast<float>(angle_of({k.c[i], k.s[i]})));
  }
}

std::unique_ptr<TrajectoryWriter> open_trajectory(const std::string& file, TrajectoryFormat format,
                                                  const Model& model, const FileDigest* keep) {
  if (format == TrajectoryFormat::csv) return open_csv_trajectory(file, keep);
  if (format == TrajectoryFormat::binary) return open_binary_trajectory(file, model, keep);
  return std::make_unique<NoWriter>();
}

Trajectory read_trajectory(const std::string& file) {
  const std::string content = read_whole(file);
  if (content.empty()) throw InputError({file}, "there is no frame in it yet");
  const bool binary = std::string_view(content).starts_with(kTrajectoryMagic);
  return binary ? parse_binary_trajectory(content, file) : parse_csv_trajectory(content, file);
}

}  // namespace lilytank
