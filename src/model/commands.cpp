#include "model/commands.hpp"

namespace lilytank {

int last_command(const Model& model, CommandKind kind, int given, int copies) {
  int last = -1;
  for (int i = 0; i < given; ++i) {
    if (model.commands[i].kind == kind) last = i;
  }
  const int timed = static_cast<int>(model.commands.size());
  for (int i = 0; i < static_cast<int>(model.feedback.size()); ++i) {
    const Command& command = model.feedback[i];
    if (command.kind == kind && command.copies <= copies) last = timed + i;
  }
  return last;
}

int said_by(const Model& model, int place, int Command::*what) {
  return place < 0 ? 0 : command_at(model, place).*what;
}

const Command& command_at(const Model& model, int index) {
  const int timed = static_cast<int>(model.commands.size());
  return index < timed ? model.commands[index] : model.feedback[index - timed];
}

}  // namespace lilytank
