// Whole numbers packed for a page: differences, zigzag code, planes of bytes, deflate, base64.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/json.hpp"

namespace lilytank {

/// Collects columns of whole numbers. src/view/player_tank.js reads them.
class ViewPack {
 public:
  /// Adds a column that consists of series of `length` numbers each, such as one body's positions.
  /// Each series is stored as its differences of the order (0 .. 2) that gives the smallest
  /// numbers. Returns what the page needs to read it: {at, count, length, order, planes}.
  Json add(std::span<const std::int32_t> values, std::size_t length);
  /// All columns, deflated, as base64.
  std::string text() const;

 private:
  std::string bytes_;
};

}  // namespace lilytank
