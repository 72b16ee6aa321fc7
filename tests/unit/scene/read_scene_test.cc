#include "simulator/scene/read_scene.h"
#include <gtest/gtest.h>
namespace faultsim {
TEST(S, Reads) {
  const std::string folder = FAULTSIM_SOURCE_DIR "/docs/examples/scenes/";
  for (const char* file : {"rotliegend.json", "rotliegend-weakening.json"}) {
    try {
      read_scene(read_json_file(folder + file));
    } catch (const InputError& e) {
      FAIL() << e.what();
    }
  }
  for (const char* kind : {"field", "box"}) {
    try {
      read_scene(parse_json(starter_scene(kind), kind));
    } catch (const InputError& e) {
      FAIL() << e.what();
    }
  }
  for (const auto& p : parameters(read_json_file(folder + "rotliegend.json")))
    std::cout << p.pointer << " | " << p.alias << " | " << p.value << " | " << p.default_value
              << " | " << p.range << " | " << p.new_family << "\n";
  std::cout << canonical_scene(read_scene(read_json_file(folder + "rotliegend.json"))) << "\n";
}
}  // namespace faultsim
