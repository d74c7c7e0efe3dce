#include <bit>
#include <cmath>
#include <cstring>

#include "io/append_file.hpp"
#include "io/file_digest.hpp"
#include "io/trajectory_format.hpp"

namespace lilytank {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

template <class T>
T take(std::string_view& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return value;
}

void put_markings(std::string& bytes, const Markings& m) {
  put(bytes, m.label), put(bytes, m.last), put(bytes, m.latched);
  put(bytes, m.bonded), put(bytes, m.complete);
}

Markings take_markings(std::string_view& bytes) {
  Markings m;
  m.label = take<std::int16_t>(bytes), m.last = take<std::int8_t>(bytes);
  m.latched = take<std::uint8_t>(bytes), m.bonded = take<std::uint8_t>(bytes);
  m.complete = take<std::uint8_t>(bytes);
  return m;
}

class BinaryWriter final : public TrajectoryWriter {
 public:
  BinaryWriter(const std::string& file, const Model& model, const FileDigest* keep)
      : out_(keep == nullptr ? AppendFile(file) : AppendFile(file, *keep)) {
    if (keep != nullptr) return;
    std::string header(kTrajectoryMagic);
    put(header, kTrajectoryVersion);
    put(header, static_cast<std::uint32_t>(model.bodies()));
    put(header, static_cast<std::uint32_t>(model.module.count));
    put(header, checksum_bits(header));
    out_.append(header);
  }

  void write(const World& world, const std::vector<std::uint8_t>& complete) override {
    const Kinematics& k = world.kinematics();
    frame_.clear();
    put(frame_, world.time());
    for (int b = 0; b < k.size(); ++b) {
      put(frame_, static_cast<float>(k.x[b])), put(frame_, static_cast<float>(k.y[b]));
      put(frame_, static_cast<float>(angle_of({k.c[b], k.s[b]})));
      put_markings(frame_, b < k.modules ? markings_of(world, b, complete) : Markings{});
    }
    put(frame_, checksum_bits(frame_));
    out_.append(frame_);
  }

  FileDigest flush() override { return out_.flush(); }

 private:
  AppendFile out_;
  std::string frame_;
};

void take_frame(std::string_view bytes, Trajectory& out, const std::string& file) {
  const std::string which = "frame " + std::to_string(out.time.size());
  const double time = take<double>(bytes);
  const bool late = out.time.empty() || time > out.time.back();
  if (!std::isfinite(time) || !late) throw InputError({file}, which + ": times do not rise");
  out.time.push_back(time);
  for (int b = 0; b < out.bodies; ++b) {
    const auto x = take<float>(bytes), y = take<float>(bytes), theta = take<float>(bytes);
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(theta)) {
      throw InputError({file},
                       which + ": the pose of body " + std::to_string(b) + " is not finite");
    }
    out.x.push_back(x), out.y.push_back(y), out.theta.push_back(theta);
    out.markings.push_back(take_markings(bytes));
  }
}

}  // namespace

std::unique_ptr<TrajectoryWriter> open_binary_trajectory(const std::string& file,
                                                         const Model& model,
                                                         const FileDigest* keep) {
  return std::make_unique<BinaryWriter>(file, model, keep);
}

Trajectory parse_binary_trajectory(std::string_view bytes, const std::string& file) {
  if (bytes.size() < kTrajectoryHeader) throw InputError({file}, "the trajectory's header is cut");
  const std::string_view whole = bytes;
  bytes.remove_prefix(kTrajectoryMagic.size());
  const auto version = take<std::uint32_t>(bytes);
  if (version != kTrajectoryVersion) {
    throw InputError({file}, "trajectory version " + std::to_string(version) + " instead of " +
                                 std::to_string(kTrajectoryVersion));
  }
  const auto bodies = take<std::uint32_t>(bytes), modules = take<std::uint32_t>(bytes);
  const auto header = whole.substr(0, kTrajectoryHeader - sizeof(std::uint32_t));
  const bool changed = take<std::uint32_t>(bytes) != checksum_bits(header);
  if (changed || bodies == 0 || bodies > 1u << 24 || modules > bodies) {
    throw InputError({file}, "the trajectory's header is damaged: " + std::to_string(bodies) +
                                 " bodies, " + std::to_string(modules) + " modules");
  }
  Trajectory out;
  out.bodies = static_cast<int>(bodies), out.modules = static_cast<int>(modules);
  const std::size_t size = kFrameTime + kFrameBody * bodies + kFrameChecksum;
  const std::size_t poses = bytes.size() / size * bodies;
  out.x.reserve(poses), out.y.reserve(poses), out.theta.reserve(poses);
  out.markings.reserve(poses);
  for (; bytes.size() >= size; bytes.remove_prefix(size)) {
    const std::string_view frame = bytes.substr(0, size - kFrameChecksum);
    std::string_view sum = bytes.substr(frame.size(), kFrameChecksum);
    if (take<std::uint32_t>(sum) != checksum_bits(frame)) {
      throw InputError({file},
                       "frame " + std::to_string(out.time.size()) + " (from byte " +
                           std::to_string(whole.size() - bytes.size()) +
                           ") was changed since it was written; --force runs the run again");
    }
    take_frame(frame, out, file);
  }
  return out;
}

}  // namespace lilytank
