#include "simulator/case_figures/picture_file.h"

#include <cstring>

#include "simulator/common/child_output.h"
#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/output_target.h"

namespace faultsim {
namespace {

constexpr const char* kConverter = "rsvg-convert";

std::string png_of(const std::string& svg) {
  const ChildOutput made = run_child({kConverter, "--zoom=2", "--format=png"}, svg);
  if (made.start_error != 0) {
    throw InputError("-o",
                     concat("a PNG is made by ", kConverter, ", which does not run (",
                            std::strerror(made.start_error), ")"),
                     "install librsvg (Debian: librsvg2-bin), or write a .svg");
  }
  if (made.code != 0 || made.out.rfind("\x89PNG", 0) != 0) {
    throw StorageError(concat(kConverter, " made no PNG (exit code ", made.code, ")"));
  }
  return made.out;
}

}  // namespace

void require_picture_file(const std::filesystem::path& target,
                          const std::vector<std::string>& endings,
                          const std::vector<std::filesystem::path>& inputs) {
  const std::string ending = target.extension().string();
  if (!contains(endings, ending)) {
    std::string wanted = joined(endings, " or ");
    throw InputError("-o", concat("\"", target.string(), "\" does not say what to write"),
                     "let the name end in " + wanted);
  }
  require_writable_file("-o", target, FileKind::text, inputs);
}

void write_picture(const std::filesystem::path& target, const std::string& svg) {
  write_text(target, target.extension() == ".png" ? png_of(svg) : svg);
}

}  // namespace faultsim
