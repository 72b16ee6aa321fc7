#pragma once

#include "campaign/query/ranking.h"
#include "campaign/render/answer.h"

namespace faultsweep {

/// How many slide and which is the riskiest, then "cases": the ranking as a table. What the cells
/// do not resolve says so in its row.
Answer to_answer(const Ranking& ranking);
/// The same without the columns that only files have: for pages of very many rows.
Answer answer_of_page(const Ranking& ranking);
/// The metrics that rank --by and --where know, with unit and meaning.
Answer metrics_answer();
/// How often it slides, in a sentence: "24 of 240 cases slide; ...".
std::string sliding_sentence(const SlidingCounts& counts, const RankRequest& request);

}  // namespace faultsweep
