#pragma once

#include <string_view>

#include "simulator/common/struct_of.h"

/// A key of a scene is said once, beside the struct that it is a member of: for_each_key(struct,
/// visit) calls visit(SceneKey, member) for each member that a document says. What reads documents
/// (reading/read_keys.h), the canonical text and with it a case's identity (identity.cc), and the
/// family (plan/family.cc) are written from it; words(enum) are the words of an enumeration, in its
/// order. Unit, range and default of a key are those of schemas/scene.schema.json.
namespace faultsim {

/// What is to be known of a key besides its name.
enum KeyTrait : unsigned {
  kRequired = 1,  ///< every document has it: one that lacks it is refused, and it reads as NaN.
  kByHand = 2,    ///< not read by its name: the reader of its struct sees to it.
  kIdle = 4,      ///< other keys make it say nothing: neither read nor part of the identity.
  /// Not in the canonical text. A key that came later stands in it only where it differs from what
  /// reproduces the old behaviour, so that identities stored before stay valid.
  kSilent = 8,
  kWord = 16,    ///< stands in the canonical text as its word, not its number.
  kFamily = 32,  ///< the linear bulk depends on it.
};
constexpr unsigned unless(bool condition, unsigned trait) { return condition ? 0 : trait; }

/// How a document and the canonical text say a member.
struct SceneKey {
  std::string_view name;          ///< in the document.
  unsigned traits = 0;            ///< of KeyTrait.
  std::string_view in_text = {};  ///< in the canonical text; "" = the same.
  constexpr bool is(unsigned trait) const { return (traits & trait) != 0; }
};

}  // namespace faultsim
