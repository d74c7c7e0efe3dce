// The player, whose text the build takes from player.html, player.css and player.js.
#pragma once
#include <string_view>

namespace lilytank {

extern const std::string_view kPlayerPage, kPlayerStyle, kPlayerScript;

}  // namespace lilytank
