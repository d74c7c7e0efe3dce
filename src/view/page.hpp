// The player, which the build takes from player.html, player.css and player_*.js.
#pragma once
#include <string_view>

namespace lilytank {

extern const std::string_view kPlayerPage, kPlayerStyle, kPlayerScript;

}  // namespace lilytank
