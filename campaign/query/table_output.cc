#include "campaign/query/table_output.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>

#include "simulator/common/errors.h"
#include "simulator/files/atomic_file.h"

namespace faultsweep {

struct TableOutput::File {
  explicit File(const std::filesystem::path& target) : pending(target) {}
  faultsim::PendingFile pending;
  std::size_t size = 0;
};

TableOutput::TableOutput(const std::filesystem::path& target)
    : file_(target.empty() ? nullptr : std::make_unique<File>(target)) {}
TableOutput::TableOutput(TableOutput&&) noexcept = default;
TableOutput::~TableOutput() = default;

void TableOutput::write(std::string_view text) {
  constexpr std::size_t kFull = 1 << 16;
  buffer_ += text;
  if (buffer_.size() >= kFull) flush();
}

void TableOutput::flush() {
  if (file_) {
    file_->pending.write(buffer_.data(), buffer_.size(), file_->size);
    file_->size += buffer_.size();
  } else if (std::fwrite(buffer_.data(), 1, buffer_.size(), stdout) != buffer_.size()) {
    throw faultsim::StorageError("the output could not be written completely (disk full?)");
  }
  buffer_.clear();
}

void TableOutput::finish() {
  flush();
  if (file_) {
    file_->pending.commit();
  } else if (std::fflush(stdout) != 0) {
    throw faultsim::StorageError("the output could not be written completely (disk full?)");
  }
}

std::string rounded_number(double value) {
  if (std::isnan(value)) return "nan";
  constexpr int kDigits = 12;
  char text[32];
  return {text,
          std::to_chars(text, text + sizeof text, value, std::chars_format::general, kDigits).ptr};
}

std::string cell_text(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return exact_number(*number);
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return std::to_string(*whole);
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  return "";
}

double number_of(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*whole);
  return std::numeric_limits<double>::quiet_NaN();
}

std::string csv_cell(const Cell& cell) {
  const auto* text = std::get_if<std::string>(&cell);
  return text != nullptr ? csv_name(*text) : cell_text(cell);
}

std::string one_word(const std::string& text) {
  if (text.empty()) return "_";
  std::string word = text;
  for (char& letter : word) {
    const bool plain = letter > ' ' && letter <= '~' && letter != '"' && letter != '\'';
    if (!plain) letter = '_';
  }
  return word;
}

std::string column_name(const std::string& given, faultsim::Dimension dimension) {
  std::string name = given;
  std::ranges::replace(name, ' ', '_');
  const bool magnitude =
      dimension == faultsim::Dimension::number && name.find("magnitude") != std::string::npos;
  return name + (magnitude ? "_mw" : faultsim::info_of(dimension).suffix);
}

std::string column_name(const MetricInfo& metric, bool plane_strain) {
  const std::string name = column_name(metric.name, metric.dimension);
  return plane_strain && metric.is_extensive() ? name + "_per_m" : name;
}

}  // namespace faultsweep
