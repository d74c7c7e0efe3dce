#include "control/exchange.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "lilytank/math.hpp"
#include "lilytank/random.hpp"
#include "math/bulk_random.hpp"

namespace lilytank {
namespace {

double unit(std::uint32_t bits) {
  return (bits + 0.5) * 0x1p-32;
}

}  // namespace

Exchange::Exchange(const Model& model)
    : model_(&model),
      begins_below_(static_cast<std::uint64_t>(model.control.initiative * 0x1p32)),
      log_quiet_(0),
      begins_at_(std::min(model.control.reply_ticks, kMostReplyTicks) + 2),
      confirmed_(model.control.handshake == Handshake::confirmed) {
  const double rate = model.control.evaluation_rate * kTick;
  if (rate > 0 && rate < 1) log_quiet_ = log_portable(1 - rate);
  answers_.reserve(static_cast<std::size_t>(model.module.count));
  senders_.reserve(static_cast<std::size_t>(model.module.count));
}

void Exchange::run(Tick& tick) {
  if (model_->rulesets.empty()) return;
  if (model_->control.clock == Clock::firmware)
    firmware(tick);
  else
    events(tick);
}

void Exchange::firmware(Tick& tick) {
  answers_.clear();
  senders_.clear();
  alignas(64) std::uint32_t bits[kBulkBodies];
  for (int i = 0; i < model_->module.count; ++i) {
    if (i % kBulkBodies == 0)
      bulk_words(
          {tick.state.seed, Stream::initiative, tick.number, static_cast<std::uint32_t>(i), 0},
          bits);
    const bool begins = bits[i % kBulkBodies] < begins_below_;
    Firmware& firmware = tick.state.firmware[i];
    const bool idle = firmware.waiting == 0;
    const bool acts = (begins & idle) | (firmware.waiting == begins_at_) | (firmware.mail != 0) |
                      (firmware.power != Power::on) | (firmware.bound != 0);
    if (acts)
      act(tick, i, begins);
    else
      firmware.waiting = static_cast<std::uint8_t>(firmware.waiting - (idle ? 0 : 1));
  }
  // An initiator waits and a responder was idle, so these pairs have no module in common.
  for (const Connector& responder : answers_) {
    if (confirmed_) {
      commit(tick, responder);
      continue;
    }
    const Face& face = face_of(tick.state, responder);
    const Connector initiator{face.partner, face.partner_face};
    const std::uint32_t random = face.random;
    tick.state.firmware[initiator.module].waiting = 1;
    tick.state.firmware[responder.module].waiting = 1;
    decide(tick, initiator, responder, random);
  }
  for (int i = 0; confirmed_ && i < model_->module.count; ++i) repeat(tick, i);
  for (const std::int32_t sender : senders_) send(tick, sender);
}

// What one module does in this tick, as far as it concerns no other.
void Exchange::act(Tick& tick, int module, bool initiative) {
  std::uint32_t heard_at[4];
  const int messages = heard(tick, module, heard_at);
  Firmware& firmware = tick.state.firmware[module];
  if (!tick.on(module) || firmware.bound != 0) return;
  if (firmware.waiting > 0) {
    if (firmware.waiting == begins_at_) senders_.push_back(module);
    --firmware.waiting;
    return;
  }
  if (initiative) {
    firmware.waiting = static_cast<std::uint8_t>(begins_at_);
    return;
  }
  if (messages == 0) return;
  std::uint64_t which = 0;
  if (messages > 1) {
    const auto bits = random_bits(
        {tick.state.seed, Stream::answer, tick.number, static_cast<std::uint32_t>(module), 0});
    which = static_cast<std::uint64_t>(bits[0]) * static_cast<std::uint64_t>(messages) >> 32;
  }
  answers_.push_back({module, static_cast<std::int32_t>(heard_at[which])});
}

// Takes the messages off a module's faces; those of a sender that was switched off do not count.
int Exchange::heard(Tick& tick, int module, std::uint32_t (&faces)[4]) const {
  std::uint8_t& mail = tick.state.firmware[module].mail;
  if (mail == 0) return 0;
  int count = 0;
  for (std::uint32_t f = 0; f < 4; ++f) {
    if ((mail >> f & 1) == 0) continue;
    const Face& face = tick.state.faces[4 * module + f];
    if (holds(face) && tick.on(face.partner)) faces[count++] = f;
  }
  mail = 0;
  return count;
}

void Exchange::send(Tick& tick, int module) {
  Firmware& firmware = tick.state.firmware[module];
  const int f = firmware.next_face;
  firmware.next_face = static_cast<std::uint8_t>((f + 1) & 3);
  const Face& face = face_of(tick.state, {module, f});
  if (!holds(face)) return;
  const auto bits = random_bits(
      {tick.state.seed, Stream::message, tick.number, static_cast<std::uint32_t>(module), 0});
  if (fails(tick, {module, f}, Fault::message)) return;
  Face& neighbour = face_of(tick.state, {face.partner, face.partner_face});
  neighbour.random = bits[0];
  std::uint8_t& mail = tick.state.firmware[face.partner].mail;
  mail = static_cast<std::uint8_t>(mail | 1u << face.partner_face);
}

void Exchange::events(Tick& tick) {
  for (int i = 0; confirmed_ && i < model_->module.count; ++i) repeat(tick, i);
  for (int i = 0; i < model_->module.count; ++i) {
    for (int f = 0; f < 4; ++f) {
      const Connector lower{i, f};
      Face& face = face_of(tick.state, lower);
      if (face.partner <= i || face.due > tick.number) continue;
      const bool fresh = face.due == 0;  // latched since the last tick
      face.due = rest(tick, lower);
      // Waiting has no memory, so a pause only passes the time.
      if (fresh || !tick.on(i) || !tick.on(face.partner)) continue;
      if (tick.state.firmware[i].bound != 0 || tick.state.firmware[face.partner].bound != 0)
        continue;
      if (fails(tick, lower, Fault::message)) continue;
      const auto bits = random_bits({tick.state.seed, Stream::evaluation, tick.number,
                                     static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(f)});
      Connector initiator = lower, responder{face.partner, face.partner_face};
      if ((bits[0] & 1) == 0) std::swap(initiator, responder);
      if (confirmed_) {
        face_of(tick.state, responder).random = bits[1];
        commit(tick, responder);
      } else {
        decide(tick, initiator, responder, bits[1]);
      }
    }
  }
}

// The tick of a connection's next evaluation: geometric, the inverse of its distribution function.
std::int64_t Exchange::rest(const Tick& tick, Connector at) const {
  const double rate = model_->control.evaluation_rate * kTick;
  if (rate <= 0) return std::numeric_limits<std::int64_t>::max();
  if (rate >= 1) return tick.number + 1;
  const double u =
      uniform({tick.state.seed, Stream::evaluation, tick.number,
               static_cast<std::uint32_t>(at.module), static_cast<std::uint32_t>(at.face + 4)});
  return tick.number + 1 + static_cast<std::int64_t>(log_portable(u) / log_quiet_);
}

void Exchange::decide(Tick& tick, Connector initiator, Connector responder, std::uint32_t random) {
  State& state = tick.state;
  const auto label = [&](Connector at) {
    const Firmware& firmware = state.firmware[at.module];
    return Label{firmware.label, hop_of(firmware.last, at.face)};
  };
  const bool standing = face_of(state, initiator).status == FaceStatus::bonded;
  ++tick.tallies.evaluations;
  const Match found =
      match(rules(tick), label(initiator), label(responder), standing, unit(random));
  const bool ends = found.rule < 0 ? !standing && !found.applicable
                                   : rules(tick).rules[found.rule].kind == RuleKind::unlink;
  if (ends && fails(tick, responder, Fault::release)) return;
  if (found.rule >= 0) {
    const Firmware before = state.firmware[initiator.module];
    if (found.swapped)
      apply(tick, found.rule, responder, initiator);
    else
      apply(tick, found.rule, initiator, responder);
    if (confirmed_ || !fails(tick, initiator, Fault::answer)) return;
    state.firmware[initiator.module].label = before.label;
    state.firmware[initiator.module].last = before.last;
  } else if (ends) {
    release(tick, initiator, responder);
    report(tick, EventKind::unlatch, initiator, responder);
  }
}

void Exchange::apply(Tick& tick, int index, Connector first, Connector second) {
  const Rule& rule = rules(tick).rules[static_cast<std::size_t>(index)];
  const Connector both[2] = {first, second};
  for (int k = 0; k < 2; ++k) {
    Firmware& firmware = tick.state.firmware[both[k].module];
    firmware.label = rule.after[k].state;
    firmware.last = static_cast<std::int8_t>(last_after(both[k].face, rule.after[k].hop));
  }
  EventKind kind = EventKind::update;
  if (rule.kind == RuleKind::link) {
    kind = EventKind::link;
    face_of(tick.state, first).status = face_of(tick.state, second).status = FaceStatus::bonded;
  } else if (rule.kind == RuleKind::unlink) {
    kind = EventKind::unlink;
    release(tick, first, second);
  }
  report(tick, kind, first, second, index);
}

}  // namespace lilytank
