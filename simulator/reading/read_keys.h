#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "simulator/common/words.h"
#include "simulator/reading/scene_reader.h"
#include "simulator/scene/scene.h"

/// Inside of read_scene: members by the list of keys (scene.h). What is not given keeps its
/// value; numbers that had to be given are NaN.
namespace faultsim {

template <typename Value>
constexpr bool is_list_of_numbers = false;
template <std::size_t n>
constexpr bool is_list_of_numbers<std::array<double, n>> = true;

/// What is not given keeps its value.
template <typename Value>
void read_value(const SceneReader& reader, const KeyPlace& at, Value& value) {
  if (at.value == nullptr) return;
  if constexpr (std::is_same_v<Value, double>) {
    value = reader.real(at);
  } else if constexpr (std::is_same_v<Value, int>) {
    value = reader.integer(at, value);
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = reader.boolean(at, value);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    value = reader.text(at);
  } else if constexpr (std::is_enum_v<Value>) {
    value = named<Value>(reader.text(at)).value_or(value);
  } else if constexpr (is_list_of_numbers<Value>) {
    const std::string list = at.pointer();
    for (std::size_t i = 0; i < value.size(); ++i) {  // of nine numbers three rows
      const bool is_tensor = value.size() == 9;
      value[i] = reader.real(is_tensor ? element(element(list, i / 3), i % 3) : element(list, i));
    }
  } else {  // optional
    read_value(reader, at, value.emplace());
  }
}

/// Other members are read by hand.
template <typename Value>
constexpr bool is_read =
    !std::is_const_v<Value> && (std::is_arithmetic_v<Value> || std::is_enum_v<Value> ||
                                is_list_of_numbers<Value> || std::is_same_v<Value, std::string>);
template <typename Value>
constexpr bool is_read<std::optional<Value>> = is_read<Value>;

/// A visitor of for_each_key that reads members. @param place_of  the place of a key.
template <typename PlaceOf>
auto key_reader(const SceneReader& reader, const PlaceOf& place_of) {
  return [&reader, place_of](const SceneKey& key, auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    if constexpr (is_read<Member>) {
      if (key.is(kByHand) || key.is(kIdle)) return;
      if (key.is(kRequired)) {
        if constexpr (std::is_same_v<Member, double>) member = kNaN;
        if constexpr (is_list_of_numbers<Member>) member.fill(kNaN);
      }
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

/// Reads the objects of a list, whose names are unique.
/// @param also  what is read or checked besides, called with the pointer to the object and a slash,
///              the object, and those before it.
template <typename Struct, typename Also>
std::vector<Struct> read_list(SceneReader& reader, const std::string& list, const Also& also) {
  std::vector<Struct> all;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < reader.size(list); ++i) {
    const std::string at = element(list, i) + "/";
    Struct one;
    read_keys(reader, at, one);
    also(at, one, all);
    names.push_back(one.name);
    all.push_back(std::move(one));
  }
  reader.require_unique(list, "/name", names);
  return all;
}

}  // namespace faultsim
