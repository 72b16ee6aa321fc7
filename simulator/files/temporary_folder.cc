#include "simulator/files/temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "simulator/common/errors.h"

namespace faultsim {

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "faultsim-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw ResourceError(concat("cannot make ", name, ": ", std::strerror(errno)));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace faultsim
