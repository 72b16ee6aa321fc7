#include "campaign/scheduler/wire.h"

#include <gtest/gtest.h>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

TEST(Wire, EventsTravel) {
  JobEvents events;
  RunRecord run;
  run.case_id = 42;
  run.status = RunStatus::completed;
  run.host = "node7";
  run.wall_seconds = 0.1;
  run.has_fields = true;
  run.fields_only = true;
  events.completed.push_back({run, std::string("a\0b", 3)});
  JobEvents::Failure failure;
  failure.run.reason = "killed";
  failure.run.signal = 9;
  failure.in_operator = true;
  events.failed.push_back(failure);
  events.returned = {7, 8};
  events.operators.push_back({"print", true, 1.5, 10, 20, 30, 40});
  events.building = "operator 3 of a surface: meshing";
  const std::string bytes = encode(events);
  const auto back = std::get<JobEvents>(decode(bytes));
  EXPECT_EQ(encode(back), bytes);
  ASSERT_EQ(back.completed.size(), 1u);
  EXPECT_EQ(back.completed[0].result, std::string("a\0b", 3));
  EXPECT_TRUE(back.completed[0].run.has_fields);
  EXPECT_TRUE(back.completed[0].run.fields_only);
  EXPECT_FALSE(back.failed[0].run.has_fields);
  EXPECT_EQ(back.failed[0].run.signal, 9);
  EXPECT_EQ(back.returned, events.returned);
  EXPECT_EQ(back.operators[0].peak_bytes, 40);
  EXPECT_EQ(back.building, events.building);
}

TEST(Wire, WorkTravels) {
  message::Work work;
  work.task.family = 3;
  work.task.time_limit = 2.5;
  work.task.keep_fields = KeepFields::all;
  work.task.fields_folder = "/store/fields/sweep";
  work.scenes = {{5, {"scene.json", "{}"}}};
  work.cases.push_back({17, 5, 9, R"({"/a": 1})"});
  const auto back = std::get<message::Work>(decode(encode(work)));
  EXPECT_EQ(back.task.time_limit, 2.5);
  EXPECT_FALSE(back.task.memory_limit);
  EXPECT_EQ(back.task.keep_fields, KeepFields::all);
  EXPECT_EQ(back.task.fields_folder, "/store/fields/sweep");
  EXPECT_EQ(back.scenes.at(0).first, 5);
  EXPECT_EQ(back.scenes.at(0).second.source, "scene.json");
  EXPECT_EQ(back.cases[0].changes, R"({"/a": 1})");
}

TEST(Wire, BrokenBytesAreABug) {
  std::string bytes = encode(message::Hello{"node", 4});
  EXPECT_THROW(decode(bytes.substr(0, bytes.size() - 1)), faultsim::InternalError);
  EXPECT_THROW(decode(bytes + "x"), faultsim::InternalError);
  EXPECT_THROW(decode("\x63"), faultsim::InternalError);
}

}  // namespace
}  // namespace faultsweep
