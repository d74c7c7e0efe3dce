#include "control/tick.hpp"

#include <utility>

#include "lilytank/random.hpp"

namespace lilytank {

void report(Tick& tick, EventKind kind, Connector a, Connector b, int rule) {
  if (b.module >= 0 && b.module < a.module) std::swap(a, b);
  Event event;
  event.step = tick.state.step;
  event.kind = kind;
  event.rule = static_cast<std::int16_t>(rule);
  event.a = a.module;
  event.label_a = tick.state.firmware[a.module].label;
  event.last_a = tick.state.firmware[a.module].last;
  if (b.module >= 0) {
    event.face_a = static_cast<std::int8_t>(a.face);
    event.b = b.module;
    event.face_b = static_cast<std::int8_t>(b.face);
    event.label_b = tick.state.firmware[b.module].label;
    event.last_b = tick.state.firmware[b.module].last;
  }
  tick.events.push_back(event);
}

bool fails(const Tick& tick, Connector at, Fault fault) {
  const ControlParameters& c = tick.model.control;
  const double probability[] = {c.message_loss, c.answer_loss, c.latch_failure, c.release_failure,
                                c.answer_loss};
  const auto kind = static_cast<std::uint32_t>(fault);
  if (probability[kind] <= 0) return false;
  return uniform({tick.state.seed, Stream::fault, tick.number,
                  static_cast<std::uint32_t>(at.module),
                  4 * kind + static_cast<std::uint32_t>(at.face)}) < probability[kind];
}

void clear_face(State& state, Connector at) {
  face_of(state, at) = Face{};
  std::uint8_t& mail = state.firmware[at.module].mail;
  mail = static_cast<std::uint8_t>(mail & ~(1u << at.face));
}

namespace {

void set_face(State& state, Connector at, Connector partner, FaceStatus status) {
  clear_face(state, at);
  Face& face = face_of(state, at);
  face.status = status;
  face.partner = partner.module;
  face.partner_face = static_cast<std::uint8_t>(partner.face);
}

}  // namespace

void hold(State& state, Connector a, Connector b) {
  set_face(state, a, b, FaceStatus::latched);
  set_face(state, b, a, FaceStatus::latched);
}

void release(Tick& tick, Connector a, Connector b) {
  set_face(tick.state, a, {}, FaceStatus::off);
  set_face(tick.state, b, {}, FaceStatus::off);
  tick.fetch();
  split(tick.model, tick.state, tick.assemblies, a.module);
  tick.commit();
}

}  // namespace lilytank
