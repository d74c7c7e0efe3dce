// Two modules that hold each other exchange their states and decide.
#pragma once
#include <vector>

#include "control/tick.hpp"

namespace lilytank {

/// Exchanges by the model's clock. Keeps nothing from tick to tick but memory.
///
/// Clock::firmware. Every module is a small machine; its only memory is Firmware::waiting (ticks
/// until it is idle again), Firmware::next_face and the message at a face. In one tick, all modules
/// at once:
///  - An idle module begins an exchange with probability `initiative`; that takes this tick.
///  - In the next tick it turns to its next face in the round of four, and if that face holds a
///    neighbour, sends it (label, hop, random number). Held or not, it then waits: one tick for the
///    message to arrive and up to `reply_ticks` for the answer, then it is idle.
///  - A message is heard in the tick after it was sent, by a module that is idle and does not
///    begin an exchange itself; of several it takes one at random. Messages not taken are lost.
///  - The answer is the decision: the rule is drawn with the initiator's random number, and both
///    modules change in the same tick (ideal channel). During the next tick the answer travels;
///    after it both are idle.
///
/// Handshake::plain: a request that is lost is never heard. If the answer is lost, the responder
/// has changed its labels and the latch follows, but the initiator's labels stay as they were: the
/// pair then disagrees, and assemblies that the ruleset cannot make may follow. A latch that fails
/// to let go leaves everything as it was, to be decided again.
///
/// Handshake::confirmed: a two-phase commit. Its four messages, each of which can be lost:
///
///     initiator  -- request (random number) -->                responder
///                <-- answer (label, hop) --                    bound: waits for the confirmation
///     decides, is bound  -- confirmation (decision) -->        acts, free
///     acts, free         <-- acknowledgement (done or held on) --
///
///  - A bound module keeps its labels, begins no exchange and answers no request.
///  - A bound responder repeats its answer every fourth tick until it hears a confirmation
///    or a dismissal. The initiator decides with its own labels of that moment, so it need not
///    remember its request, and may have given up waiting.
///  - An initiator that is bound itself dismisses the responder, which is then free with nothing
///    changed: no circle of modules waits for ever.
///  - A bound initiator repeats its confirmation every fourth tick until it hears the
///    acknowledgement, or until the latch has parted, which proves that the responder acted.
/// The latch holds the two together until the responder acts, so the channel lasts as long as the
/// exchange. Neither can meet another exchange between its decision and its act, so the labels and
/// the latch change in one tick here: that in which the confirmation arrives. Every change is thus
/// a rule applied to the true labels of both sides, whatever is lost. A module that is switched off
/// for good leaves a responder that waits for it bound.
///
/// A lost request, confirmation or dismissal counts by ControlParameters::message_loss, a lost
/// answer or acknowledgement by answer_loss. An exchange without loss takes effect in the same tick
/// as with Handshake::plain and keeps both modules busy for two ticks more.
///
/// With the standard numbers a bond is evaluated 0.656 times a second in a dimer, 0.670 in a
/// trimer and 0.700 in a cross of five (over 10^7 ticks and more; authors' machine: 0.66, 0.67,
/// 0.70). A machine that hears messages while it waits, or keeps them, is half as fast again.
///
/// Clock::events. Every connection of two modules that are on is evaluated after whole numbers of
/// ticks that are geometric with mean 1 / evaluation_rate exactly; a fair coin says who initiates.
class Exchange {
 public:
  explicit Exchange(const Model& model);
  /// One tick of all modules. Nothing happens without a ruleset.
  void run(Tick& tick);

 private:
  void firmware(Tick& tick);
  void events(Tick& tick);
  void act(Tick& tick, int module, bool initiative);
  int heard(Tick& tick, int module, std::uint32_t (&faces)[4]) const;
  void send(Tick& tick, int module);
  std::int64_t rest(const Tick& tick, Connector at) const;
  void decide(Tick& tick, Connector initiator, Connector responder, std::uint32_t random);
  void apply(Tick& tick, int rule, Connector first, Connector second);
  // Handshake::confirmed, in handshake.cpp.
  void commit(Tick& tick, Connector responder);
  void repeat(Tick& tick, int module);
  void answer(Tick& tick, Connector responder);
  void confirm(Tick& tick, Connector initiator);
  const Ruleset& rules(const Tick& tick) const { return model_->rulesets[tick.state.ruleset]; }

  const Model* model_;
  std::uint64_t begins_below_;         // of 2^32: initiative
  double log_quiet_;                   // log of the probability that a connection rests for a tick
  int begins_at_;                      // Firmware::waiting of a module that is about to send
  std::vector<Connector> answers_;     // responders and the faces they answer at
  std::vector<std::int32_t> senders_;  // initiators that speak in this tick
  bool confirmed_;                     // Handshake::confirmed
};

}  // namespace lilytank
