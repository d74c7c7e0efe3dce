#include "io/base64.hpp"

#include <openssl/evp.h>

#include <algorithm>

namespace lilytank {

std::string base64(std::string_view bytes) {
  constexpr std::size_t kPiece = 3 << 20;  // OpenSSL counts in int; no padding before the end
  std::string out;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(kPiece, bytes.size()))) {
    const std::string_view piece = bytes.substr(0, kPiece);
    std::string text(4 * ((piece.size() + 2) / 3) + 1, '\0');  // and the zero that OpenSSL adds
    const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                       reinterpret_cast<const unsigned char*>(piece.data()),
                                       static_cast<int>(piece.size()));
    out.append(text, 0, static_cast<std::size_t>(length));
  }
  return out;
}

}  // namespace lilytank
