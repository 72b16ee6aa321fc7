#include "campaign/app/commands.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "campaign/render/render.h"
#include "simulator/files/json_text.h"

namespace faultsweep {
namespace {

constexpr std::size_t kNarrowestScreen = 40;
std::size_t chosen_width = 0;

}  // namespace

void print_text(const std::string& text) { std::fputs(text.c_str(), stdout); }
void print_json(const nlohmann::json& document) { print_text(faultsim::json_text(document)); }

void print_answer(const Answer& answer, const StoreArguments& common) {
  print_text(common.json  ? faultsim::json_text(render_json(answer))
             : common.csv ? render_csv(table_named(answer, *common.csv))
                          : render_text(answer, screen_width()));
}

void set_screen_width(std::size_t width) { chosen_width = width; }

std::size_t screen_width() {
  if (chosen_width > 0) return chosen_width;
  winsize size = {};
  std::size_t width = kScreenWidth;
  if (isatty(STDOUT_FILENO) == 1 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
    width = size.ws_col;
  else if (const char* given = std::getenv("COLUMNS"))
    width = static_cast<std::size_t>(std::max(0L, std::strtol(given, nullptr, 10)));
  return std::max(width, kNarrowestScreen);
}

}  // namespace faultsweep
