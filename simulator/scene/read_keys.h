#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>

#include "simulator/scene/scene_keys.h"
#include "simulator/scene/scene_reader.h"

/// Inside of read_scene: members by the list of keys (scene_keys.h). What is not given keeps its
/// value; numbers that had to be given are NaN.
namespace faultsim {

inline void read_value(const SceneReader& reader, const KeyPlace& at, double& value) {
  value = reader.real(at, value);
}
inline void read_value(const SceneReader& reader, const KeyPlace& at,
                       std::optional<double>& value) {
  if (at.value != nullptr) value = reader.real(at);
}
inline void read_value(const SceneReader& reader, const KeyPlace& at, int& value) {
  value = reader.integer(at, value);
}
inline void read_value(const SceneReader& reader, const KeyPlace& at, bool& value) {
  value = reader.boolean(at, value);
}
inline void read_value(const SceneReader& reader, const KeyPlace& at, std::string& value) {
  value = reader.text(at, value);
}
template <std::size_t n>
void read_value(const SceneReader& reader, const KeyPlace& at, std::array<double, n>& value) {
  if (at.value == nullptr) return;
  const std::string pointer = at.pointer();
  for (std::size_t i = 0; i < n; ++i) {  // of nine numbers three rows
    value[i] = reader.real(n == 9 ? element(element(pointer, i / 3), i % 3) : element(pointer, i));
  }
}
template <std::size_t n>
void read_value(const SceneReader& reader, const KeyPlace& at,
                std::optional<std::array<double, n>>& value) {
  if (at.value != nullptr) read_value(reader, at, value.emplace());
}
template <typename Enum>
requires std::is_enum_v<Enum>
void read_value(const SceneReader& reader, const KeyPlace& at, Enum& value) {
  if (at.value == nullptr) return;
  const std::string word = reader.text(at);
  constexpr auto all = words(Enum());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (word == all[i]) value = static_cast<Enum>(i);
  }
}

inline void make_nan(double& value) { value = kNaN; }
template <std::size_t n>
void make_nan(std::array<double, n>& value) {
  value.fill(kNaN);
}
template <typename Value>
void make_nan(Value&) {}

/// A visitor of for_each_key that reads members. @param place_of  the place of a key.
template <typename PlaceOf>
auto key_reader(const SceneReader& reader, const PlaceOf& place_of) {
  return [&reader, place_of](const SceneKey& key, auto& member) {
    if constexpr (requires(const KeyPlace& place) { read_value(reader, place, member); }) {
      if (key.by_hand || !key.counts) return;
      if (key.required) make_nan(member);
      read_value(reader, place_of(key.name), member);
    }
  };
}

/// The places of the keys of an object. @param at  its pointer and a slash; must stay.
inline auto places_in(const SceneReader& reader, std::string_view at) {
  const nlohmann::json* object = value_at(reader.document().value, at.substr(0, at.size() - 1));
  return [object, at](std::string_view key) {
    const bool has_keys = object != nullptr && object->is_object();
    const auto found = has_keys ? object->find(key) : nlohmann::json::const_iterator();
    return KeyPlace{has_keys && found != object->end() ? &*found : nullptr, at, key};
  };
}

/// @param at  the pointer to the object and a slash.
template <typename Struct>
void read_keys(const SceneReader& reader, std::string_view at, Struct& one) {
  for_each_key(one, key_reader(reader, places_in(reader, at)));
}

}  // namespace faultsim
