// Which of the base station's commands hold.
#pragma once
#include "lilytank/model.hpp"

namespace lilytank {

/// Place of the command of a kind that holds once the first `given` of Model::commands were given
/// and so many copies are finished; those of Model::feedback count after those of time. -1: none.
int last_command(const Model& model, CommandKind kind, int given, int copies);

/// A number of the command at such a place; 0 where none was given.
int said_by(const Model& model, int place, int Command::*what);

}  // namespace lilytank
