#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "campaign/app/commands.h"

/// The command line: every command's options, in groups of commands.
namespace faultsweep {

/// All arguments of all commands; CLI11 fills them.
struct Arguments {
  StoreArguments common;
  std::string init_folder = "campaign", case_name, cache_size = "20 GB", backup_target;
  SubmitArguments submit;
  RunOptions run;
  SlurmRequest slurm;
  RankRequest rank;
  ProbabilityArguments probability;
  PosteriorRequest posterior;
  TiersArguments tiers;
  SensitivityRequest sensitivity;
  LimitsArguments limits;
  PillarArguments pillars;
  MapArguments map;
  PlotArguments plot;
  ReportArguments report;
  ShowRequest show;
  std::string why;
  bool list_metrics = false, verify = false;
  ExportRequest exporting;
  CompareArguments compare;
  RetryArguments retry;
  NightRequest nightly;
  bool nightly_json = false;
  TradeoffArguments tradeoff;
  bool nightly_history = false;
};

/// Options that several commands have.
void add_store(CLI::App* command, StoreArguments& common);
void add_campaign(CLI::App* command, StoreArguments& common);
void add_case(CLI::App* command, StoreArguments& common, std::string& name);
void add_where(CLI::App* command, std::string& where);
void add_stage_and_fault(CLI::App* command, std::string& stage, std::string& fault);
void add_json(CLI::App* command, StoreArguments& common);
void add_wide(CLI::App* command);
/// The renderings of an answer.
void add_renderings(CLI::App* command, StoreArguments& common);
CLI::Option* add_confidence(CLI::App* command, double& confidence);

/// What is stored and what it says: status, rank, show, explain, probability, posterior,
/// sensitivity, tiers, plot, report, limits, pillars, map, export, compare. `code` is what the one
/// that was given returned.
void add_answers(CLI::App& app, Arguments& a, ExitCode& code);

}  // namespace faultsweep
