#pragma once

#include <nlohmann/json_fwd.hpp>

#include "campaign/render/answer.h"

namespace faultsweep {

/// {"format": 2, "headline": [sentences], facts of Answer::facts, table key: [rows as objects],
/// "columns": {table key: [{"key", "heading", "unit"}]}, "notes": [sentences]}. Numbers are in SI,
/// all digits, null where there is none; of a cell with an error or a note "KEY_error" and
/// "KEY_note" stand beside it. All rows, whatever a screen shows. @pre no two tables have the same
/// key.
inline constexpr int kAnswerFormat = 2;  ///< of commands.schema.json.
nlohmann::ordered_json render_json(const Answer& answer);
/// The rows of a table as objects, for documents of another format.
nlohmann::json json_rows(const AnswerTable& table);

}  // namespace faultsweep
