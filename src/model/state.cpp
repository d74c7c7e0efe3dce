#include "lilytank/state.hpp"

#include <cstring>

#include "lilytank/error.hpp"
#include "text/fnv.hpp"

namespace lilytank {
namespace {

constexpr char kMagic[8] = {'L', 'T', 'S', 'T', 'A', 'T', 'E', '3'};

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};

// Hands a field's bytes to use(const void*, size), a vector's length first.
template <class Field, class Use>
void as_bytes(const Field& field, Use&& use) {
  if constexpr (IsVector<Field>::value) {
    const std::uint64_t size = field.size();
    use(&size, sizeof size);
    if (size != 0) use(field.data(), field.size() * sizeof(field[0]));
  } else {
    use(&field, sizeof field);
  }
}

}  // namespace

std::uint64_t fingerprint(const State& state) {
  std::uint64_t hash = fnv_bytes({});
  for_each_field(state, [&](const char*, const auto& field) {
    as_bytes(field, [&](const void* data, std::size_t size) {
      hash = fnv_bytes({static_cast<const char*>(data), size}, hash);
    });
  });
  return hash;
}

std::string hex(std::uint64_t value) {
  std::string text(16, '0');
  for (int i = 15; i >= 0; --i, value >>= 4) text[i] = "0123456789abcdef"[value & 15];
  return text;
}

std::string to_snapshot(const State& state, std::uint64_t identity) {
  std::string bytes(kMagic, sizeof kMagic);
  const auto append = [&](const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  };
  append(&identity, sizeof identity);
  for_each_field(state, [&](const char*, const auto& field) { as_bytes(field, append); });
  const std::uint64_t check = fingerprint(state);
  append(&check, sizeof check);
  return bytes;
}

State from_snapshot(const std::string& bytes, std::uint64_t identity, const std::string& file) {
  const SourcePlace place{file};
  std::size_t at = 0;
  const auto take = [&](void* to, std::size_t size) {
    if (size > bytes.size() - at) throw InputError(place, "the snapshot is cut short");
    std::memcpy(to, bytes.data() + at, size);
    at += size;
  };
  char magic[sizeof kMagic];
  take(magic, sizeof magic);
  if (std::memcmp(magic, kMagic, sizeof magic) != 0)
    throw InputError(place, "not a snapshot of this version");
  std::uint64_t owner = 0, check = 0;
  take(&owner, sizeof owner);
  if (owner != identity) throw InputError(place, "the snapshot belongs to another scenario");
  State state;
  for_each_field(state, [&](const char* name, auto& field) {
    if constexpr (IsVector<std::decay_t<decltype(field)>>::value) {
      std::uint64_t size = 0;
      take(&size, sizeof size);
      if (size > bytes.size()) throw InputError(place, std::string("bad length of ") + name);
      field.resize(size);
      if (size != 0) take(field.data(), size * sizeof(field[0]));
    } else {
      take(&field, sizeof field);
    }
  });
  take(&check, sizeof check);
  if (check != fingerprint(state) || at != bytes.size())
    throw InputError(place, "the snapshot is damaged");
  return state;
}

}  // namespace lilytank
