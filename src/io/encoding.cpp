#include "io/encoding.hpp"

#include <utility>

namespace lilytank {
namespace {

void put(std::uint32_t code, std::string& out) {
  const auto byte = [&](std::uint32_t b) {
    out += static_cast<char>(static_cast<unsigned char>(b));
  };
  const auto rest = [&](int shift) { byte(0x80 | ((code >> shift) & 0x3f)); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xc0 | (code >> 6)), rest(0);
  } else if (code < 0x10000) {
    byte(0xe0 | (code >> 12)), rest(6), rest(0);
  } else {
    byte(0xf0 | (code >> 18)), rest(12), rest(6), rest(0);
  }
}

constexpr std::uint32_t kUnknown = 0xfffd;

}  // namespace

TextEncoding encoding_of(std::string_view begin) {
  using namespace std::string_view_literals;
  if (begin.starts_with("\xff\xfe"sv)) return TextEncoding::utf16_little;
  if (begin.starts_with("\xfe\xff"sv)) return TextEncoding::utf16_big;
  constexpr std::size_t kLooked = 16;
  if (begin.size() < 4) return TextEncoding::utf8;
  bool little = true, big = true;
  for (std::size_t i = 0; i + 1 < begin.size() && i < kLooked; i += 2) {
    little = little && begin[i] != 0 && begin[i + 1] == 0;
    big = big && begin[i] == 0 && begin[i + 1] != 0;
  }
  return little ? TextEncoding::utf16_little : big ? TextEncoding::utf16_big : TextEncoding::utf8;
}

std::string binary_kind(std::string_view begin) {
  using namespace std::string_view_literals;
  static constexpr std::pair<std::string_view, const char*> kinds[] = {
      {"PK\x03\x04"sv,
       "a zip archive, as Excel's and LibreOffice's workbooks are; save the sheet as CSV"},
      {"\xd0\xcf\x11\xe0"sv, "an Excel workbook; save the sheet as CSV"},
      {"\x89HDF"sv, "an HDF5 file; export its table as CSV"},
      {"MATLAB 5"sv, "a MAT-file; export its table as CSV"},
      {"\x93NUMPY"sv, "a NumPy array; save it with savetxt"},
      {"PAR1"sv, "a Parquet file; export it as CSV"},
      {"\x89PNG"sv, "a picture"},
      {"\xff\xd8\xff"sv, "a picture"},
      {"%PDF"sv, "a PDF document"},
      {"\xff\xfe\x00\x00"sv, "UTF-32; save it as UTF-8"},
      {"\x1f\x8b"sv, "compressed by gzip; unpack it"},
      {"BZh"sv, "compressed by bzip2; unpack it"},
      {"\xfd"
       "7zXZ"sv,
       "compressed by xz; unpack it"},
      {"\x28\xb5\x2f\xfd"sv, "compressed by zstd; unpack it"},
      {"SQLite format"sv, "an SQLite database; export the table as CSV"},
  };
  for (const auto& [bytes, kind] : kinds) {
    if (begin.starts_with(bytes)) return std::string("this is no text table but ") + kind;
  }
  constexpr std::size_t kLooked = 1024;
  const bool zeros = begin.substr(0, kLooked).find('\0') != std::string_view::npos;
  if (!zeros || encoding_of(begin) != TextEncoding::utf8) return "";
  return "this is no text table but a binary file: it holds zero bytes";
}

void Utf16Decoder::decode(std::string_view bytes, bool last, std::string& out) {
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (half_ < 0) {
      half_ = byte;
      continue;
    }
    const int low = big_ ? byte : half_, high = big_ ? half_ : byte;
    half_ = -1;
    unit(static_cast<std::uint16_t>(low | (high << 8)), out);
  }
  if (!last) return;
  if (half_ >= 0 || high_ != 0) put(kUnknown, out);
  half_ = -1, high_ = 0;
}

void Utf16Decoder::unit(std::uint16_t unit, std::string& out) {
  const bool high = unit >= 0xd800 && unit < 0xdc00, low = unit >= 0xdc00 && unit < 0xe000;
  if (low && high_ != 0) {
    put(0x10000 + ((high_ - 0xd800u) << 10) + (unit - 0xdc00u), out);
    high_ = 0;
    return;
  }
  if (high_ != 0) put(kUnknown, out);
  high_ = high ? unit : 0;
  if (!high) put(low ? kUnknown : unit, out);
}

}  // namespace lilytank
