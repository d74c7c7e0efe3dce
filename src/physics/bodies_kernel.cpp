#include "bodies.hpp"

#include <cstring>

// Compiled once for each instruction set, with the same bits from each: a lane is a body.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "physics/bodies_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace bodies_lanes {
namespace {
#define LILYTANK_LANES kBodyLanes
#include "lanes_inl.hpp"
#undef LILYTANK_LANES

HWY_INLINE F at(const float* p, int i) {
  return hn::Load(FloatTag(), p + i);
}
HWY_INLINE void put(F v, float* p, int i) {
  hn::Store(v.v, FloatTag(), p + i);
}
HWY_INLINE std::uint64_t bits_of(Mask m) {
#if HWY_MAX_BYTES == 64
  return m.m.raw;
#else
  std::uint8_t part[8] = {};
  hn::StoreMaskBits(FloatTag(), m.m, part);
  std::uint64_t word = 0;
  std::memcpy(&word, part, sizeof word);
  return word;
#endif
}
constexpr int kEach = static_cast<int>(hn::MaxLanes(FloatTag()));
}  // namespace

bool kick(Bodies& b, float dt, float fastest) {
  Mask good = {(F(0.0f) <= F(0.0f))};
  for (int i = 0; i < b.padded; i += kEach) {
    const F per_mass = dt * at(b.inv_mass, i);
    const F old_x = at(b.vx, i), old_y = at(b.vy, i), old = at(b.omega, i);
    put(old_x, b.to_x, i), put(old_y, b.to_y, i), put(old, b.to_c, i);
    const F vx = old_x + per_mass * at(b.fx, i), vy = old_y + per_mass * at(b.fy, i);
    const F omega = old + dt * at(b.inv_inertia, i) * at(b.torque, i);
    const F rim = omega * at(b.size, i);
    good &= vx * vx + vy * vy + rim * rim <= fastest * fastest;
    put(vx, b.vx, i), put(vy, b.vy, i), put(omega, b.omega, i);
  }
  return !any(~good);
}

float look(Bodies& b, float h, float tank, std::uint64_t* at_wall) {
  F most = 0.0f;
  Mask good = {(F(0.0f) <= F(0.0f))};
  for (int i = 0; i < b.padded; i += kEach) {
    const F vx = at(b.vx, i), vy = at(b.vy, i), size = at(b.size, i);
    // A member's path leaves a straight line as its group turns.
    const F turned = h * abs(at(b.omega, i)), arc = 0.5f * turned * turned * at(b.radius, i);
    const F way = h * root(vx * vx + vy * vy);
    const F reach = size + (arc + (way + 2e-5f));
    const F longest = way + (arc + turned * size);
    most = greater(most, longest), good &= longest < kEndless;
    put(arc, b.arc, i), put(reach, b.reach, i);
    const F x = at(b.x, i), y = at(b.y, i), inner = greater(tank - reach, 0.0f);
    if (i % 64 == 0) at_wall[i / 64] = 0;
    at_wall[i / 64] |= bits_of(x * x + y * y >= inner * inner) << (i % 64);
  }
  return any(~good) ? kEndless : hn::GetLane(hn::MaxOfLanes(FloatTag(), most.v));
}

void near(const Bodies& b, const float* reach, std::uint64_t* bits) {
  for (int i = 0; i < b.count; ++i) {
    const F x = b.x[i], y = b.y[i], r = reach[i];
    std::uint64_t sum = 0;
    for (int k = i / kEach * kEach; k < b.padded; k += kEach) {
      const F dx = at(b.x, k) - x, dy = at(b.y, k) - y, touch = at(reach, k) + r;
      sum |= bits_of(dx * dx + dy * dy < touch * touch) << k;
    }
    bits[i] = sum;
  }
}

std::uint64_t about(const Bodies& b, float x, float y, float reach, int first) {
  std::uint64_t sum = 0;
  for (int k = first; k < b.padded && k < first + 64; k += kEach) {
    const F dx = at(b.to_x, k) - x, dy = at(b.to_y, k) - y;
    sum |= bits_of(dx * dx + dy * dy < reach * reach) << (k - first);
  }
  return sum;
}

void fly(Bodies& b, float h) {
  const Mask all = {(F(0.0f) <= F(0.0f))};
  for (int i = 0; i < b.padded; i += kEach) {
    put(at(b.x, i) + h * at(b.vx, i), b.to_x, i), put(at(b.y, i) + h * at(b.vy, i), b.to_y, i);
    F c = at(b.c, i), s = at(b.s, i);
    turn(c, s, h * at(b.omega, i), all);
    put(c, b.to_c, i), put(s, b.to_s, i);
  }
}

void arrive(Bodies& b, float linear, float angular) {
  for (int i = 0; i < b.padded; i += kEach) {
    put(at(b.to_x, i), b.x, i), put(at(b.to_y, i), b.y, i);
    put(at(b.to_c, i), b.c, i), put(at(b.to_s, i), b.s, i);
    const F vx = at(b.vx, i), vy = at(b.vy, i), omega = at(b.omega, i);
    put(vx - linear * vx, b.vx, i), put(vy - linear * vy, b.vy, i);
    put(omega - angular * omega, b.omega, i);
  }
}
}  // namespace bodies_lanes

bool kick_bodies(Bodies& b, float dt, float fastest) {
  return bodies_lanes::kick(b, dt, fastest);
}
float look_bodies(Bodies& b, float h, float tank, std::uint64_t* at_wall) {
  return bodies_lanes::look(b, h, tank, at_wall);
}
void near_bodies(const Bodies& b, const float* reach, std::uint64_t* bits) {
  bodies_lanes::near(b, reach, bits);
}
std::uint64_t bodies_about(const Bodies& b, float x, float y, float reach, int first) {
  return bodies_lanes::about(b, x, y, reach, first);
}
void fly_bodies(Bodies& b, float h) {
  bodies_lanes::fly(b, h);
}
void arrive_bodies(Bodies& b, float linear, float angular) {
  bodies_lanes::arrive(b, linear, angular);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(kick_bodies);
HWY_EXPORT(look_bodies);
HWY_EXPORT(near_bodies);
HWY_EXPORT(bodies_about);
HWY_EXPORT(fly_bodies);
HWY_EXPORT(arrive_bodies);

bool kick_all(Bodies& b, float dt, float fastest) {
  return HWY_DYNAMIC_DISPATCH(kick_bodies)(b, dt, fastest);
}
float look_ahead(Bodies& b, float h, float tank, std::uint64_t* at_wall) {
  return HWY_DYNAMIC_DISPATCH(look_bodies)(b, h, tank, at_wall);
}
void near_bits(const Bodies& b, const float* reach, std::uint64_t* bits) {
  HWY_DYNAMIC_DISPATCH(near_bodies)(b, reach, bits);
  const std::uint64_t real = b.count < 64 ? (std::uint64_t{1} << b.count) - 1 : ~std::uint64_t{0};
  for (int i = 0; i < b.count; ++i) bits[i] &= real;
}
std::uint64_t bits_about(const Bodies& b, float x, float y, float reach, int first) {
  const std::uint64_t bits = HWY_DYNAMIC_DISPATCH(bodies_about)(b, x, y, reach, first);
  const int left = b.count - first;
  return left < 64 ? bits & ((std::uint64_t{1} << left) - 1) : bits;
}
void fly_all(Bodies& b, float h) {
  HWY_DYNAMIC_DISPATCH(fly_bodies)(b, h);
}
void arrive_all(Bodies& b, float linear, float angular) {
  HWY_DYNAMIC_DISPATCH(arrive_bodies)(b, linear, angular);
}

}  // namespace lilytank
#endif
