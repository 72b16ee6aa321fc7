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

inline void read_value(const SceneReader& reader, const std::string& at, double& value) {
  value = reader.real(at, value);
}
inline void read_value(const SceneReader& reader, const std::string& at,
                       std::optional<double>& value) {
  if (reader.has(at)) value = reader.real(at);
}
inline void read_value(const SceneReader& reader, const std::string& at, int& value) {
  value = reader.integer(at, value);
}
inline void read_value(const SceneReader& reader, const std::string& at, bool& value) {
  value = reader.boolean(at, value);
}
inline void read_value(const SceneReader& reader, const std::string& at, std::string& value) {
  value = reader.text(at, value);
}
template <std::size_t n>
void read_value(const SceneReader& reader, const std::string& at, std::array<double, n>& value) {
  if (!reader.has(at)) return;
  for (std::size_t i = 0; i < n; ++i) {  // of nine numbers three rows
    value[i] = reader.real(n == 9 ? element(element(at, i / 3), i % 3) : element(at, i));
  }
}
template <std::size_t n>
void read_value(const SceneReader& reader, const std::string& at,
                std::optional<std::array<double, n>>& value) {
  if (reader.has(at)) read_value(reader, at, value.emplace());
}
template <typename Enum>
requires std::is_enum_v<Enum>
void read_value(const SceneReader& reader, const std::string& at, Enum& value) {
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

/// A visitor of for_each_key that reads members. @param at  the pointer to a key.
template <typename PointerOf>
auto key_reader(const SceneReader& reader, const PointerOf& at) {
  return [&reader, at](const SceneKey& key, auto& member) {
    if constexpr (requires(const std::string& where) { read_value(reader, where, member); }) {
      if (key.by_hand || !key.counts) return;
      if (key.required) make_nan(member);
      read_value(reader, at(key.name), member);
    }
  };
}

/// @param at  the pointer to the object and a slash.
template <typename Struct>
void read_keys(const SceneReader& reader, const std::string& at, Struct& one) {
  const auto pointer = [&at](std::string_view key) { return at + std::string(key); };
  for_each_key(one, key_reader(reader, pointer));
}

}  // namespace faultsim
