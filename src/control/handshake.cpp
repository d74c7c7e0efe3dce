// The confirmed handshake of Exchange: two-phase commit over a channel that loses messages.
#include "control/exchange.hpp"

namespace lilytank {
namespace {

constexpr std::uint8_t kRoundTicks = 3;  // for an answer, its confirmation, the acknowledgement

std::uint8_t answered_at(int face) {
  return static_cast<std::uint8_t>(1 + face);
}
std::uint8_t decided_at(int face) {
  return static_cast<std::uint8_t>(5 + face);
}

}  // namespace

// A responder that heard a request answers it.
void Exchange::commit(Tick& tick, Connector responder) {
  Firmware& own = tick.state.firmware[responder.module];
  Firmware& other = tick.state.firmware[face_of(tick.state, responder).partner];
  own.bound = answered_at(responder.face);
  own.waiting = kRoundTicks;
  if (other.bound == 0) other.waiting = kRoundTicks;
  answer(tick, responder);
}

// One tick of a bound module: counts down to its next message, and sends it.
void Exchange::repeat(Tick& tick, int module) {
  Firmware& firmware = tick.state.firmware[module];
  if (firmware.bound == 0 || !tick.on(module)) return;
  if (firmware.waiting > 0) {
    --firmware.waiting;
    return;
  }
  firmware.waiting = kRoundTicks;
  if (firmware.bound < decided_at(0))
    answer(tick, {module, firmware.bound - answered_at(0)});
  else
    confirm(tick, {module, firmware.bound - decided_at(0)});
}

// The answer, and what the initiator makes of it.
void Exchange::answer(Tick& tick, Connector responder) {
  Firmware& own = tick.state.firmware[responder.module];
  const Face& face = face_of(tick.state, responder);
  if (!holds(face)) {  // parted: nothing is left to decide
    own.bound = 0;
    return;
  }
  const Connector initiator{face.partner, face.partner_face};
  Firmware& other = tick.state.firmware[initiator.module];
  if (!tick.on(initiator.module) || fails(tick, responder, Fault::answer)) return;
  if (other.bound == decided_at(initiator.face)) return;  // repeats its confirmation by itself
  if (other.bound != 0) {                                 // dismisses the responder
    if (!fails(tick, initiator, Fault::message)) own.bound = 0;
    return;
  }
  other.bound = decided_at(initiator.face);
  other.waiting = kRoundTicks;
  confirm(tick, initiator);
}

// The confirmation, what the responder does on it, and its acknowledgement.
void Exchange::confirm(Tick& tick, Connector initiator) {
  Firmware& own = tick.state.firmware[initiator.module];
  const Face face = face_of(tick.state, initiator);
  if (!holds(face)) {  // parted: the responder acted
    own.bound = 0;
    return;
  }
  const Connector responder{face.partner, face.partner_face};
  if (!tick.on(responder.module) || fails(tick, initiator, Fault::message)) return;
  Firmware& other = tick.state.firmware[responder.module];
  if (other.bound == answered_at(responder.face)) {
    other.bound = 0;
    decide(tick, initiator, responder, face_of(tick.state, responder).random);
  }
  const bool parted = !holds(face_of(tick.state, initiator));
  if (parted || !fails(tick, responder, Fault::acknowledgement)) own.bound = 0;
}

}  // namespace lilytank
