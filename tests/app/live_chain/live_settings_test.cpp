// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_settings.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/live_chain/live_streams.h"

namespace marey::app {
namespace {

LiveSettings settings() {
  LiveSettings out;
  out.rate = {29.97};
  out.camera_sigma_m = 0.1 / 3.0;
  out.lag_known = {true, false};
  out.avatars = {"man.vrm", "robot.glb"};
  out.vrchat = true;
  out.vmc_begin = Timestamp{1234567890123456789};
  out.streams.push_back({1, live::VmcRest::kRaw, 1472, 39540});
  out.streams.push_back({std::nullopt, live::VmcRest::kVrm0, std::nullopt, std::nullopt});
  return out;
}

TEST(LiveSettings, AreKeptExactly) {
  const auto back = parse_live_settings(live_settings_text(settings()), "take");
  ASSERT_TRUE(back) << back.error().message();
  EXPECT_EQ(back->rate.hz, settings().rate.hz);
  EXPECT_EQ(back->camera_sigma_m, settings().camera_sigma_m);
  EXPECT_EQ(back->lag_known, settings().lag_known);
  EXPECT_EQ(back->avatars, settings().avatars);
  ASSERT_EQ(back->streams.size(), 2U);
  EXPECT_EQ(back->streams[0].avatar, 1U);
  EXPECT_EQ(back->streams[0].rest, live::VmcRest::kRaw);
  EXPECT_EQ(back->streams[0].mtu_bytes, 1472);
  EXPECT_EQ(back->streams[0].listen_port, 39540);
  EXPECT_FALSE(back->streams[1].avatar);
  EXPECT_FALSE(back->streams[1].mtu_bytes);
  EXPECT_TRUE(back->vrchat);
  EXPECT_EQ(back->vmc_begin, settings().vmc_begin);
  LiveSettings whole_run = settings();
  whole_run.vmc_begin.reset();
  EXPECT_FALSE(parse_live_settings(live_settings_text(whole_run), "take")->vmc_begin);
}

// File names may hold any bytes; those of a take are our own.
TEST(LiveSettings, HoldNamesThatAreNotUtf8) {
  EXPECT_EQ(shown_name("/some/where/walker.glb"), "walker.glb");
  EXPECT_EQ(shown_name("/some/where/b\xF6rn.glb"), "b\uFFFDrn.glb");
  LiveSettings odd = settings();
  odd.avatars = {"b\xF6rn.glb", "robot.glb"};
  odd.avatar_files = {"1.glb", "2.glb"};
  const auto back = parse_live_settings(live_settings_text(odd), "take");
  ASSERT_TRUE(back) << back.error().message();
  EXPECT_EQ(back->avatars, (std::vector<std::string>{"b\uFFFDrn.glb", "robot.glb"}));
  EXPECT_EQ(back->avatar_files, odd.avatar_files);
  EXPECT_TRUE(
      parse_live_settings(live_settings_text(settings()), "")->avatar_files.empty());
  odd.avatar_files.pop_back();
  EXPECT_FALSE(parse_live_settings(live_settings_text(odd), "take"));
}

TEST(LiveSettings, AreRefusedWhereTheyCannotBe) {
  for (const char* text : {"",
                           "{}",
                           "[1]",
                           "not JSON",
                           R"({"rate_hz":0,"camera_sigma_m":0,"lag_known":[],)"
                           R"("avatars":[],"vmc":[],"vrchat":false})",
                           R"({"rate_hz":30,"camera_sigma_m":0,"lag_known":[],)"
                           R"("avatars":[],"vmc":[{"avatar":0,"rest":"raw",)"
                           R"("mtu_bytes":null,"listen_port":null}],"vrchat":false})"}) {
    const auto read = parse_live_settings(text, "take/live.sqlite");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().where, "take/live.sqlite");
  }
}

TEST(LiveSettings, AreDeclinedWithUnusableValues) {
  LiveSettings sound;
  sound.rate = {30.0};
  sound.streams = {{std::nullopt, live::VmcRest::kVrm0, 1472, 39540}};
  const std::string text = live_settings_text(sound);
  ASSERT_TRUE(parse_live_settings(text, "live.sqlite"));
  const std::vector<std::pair<std::string, std::string>> changes{
      {R"("rate_hz":30.0)", R"("rate_hz":1e-308)"},
      {R"("rate_hz":30.0)", R"("rate_hz":1e300)"},
      {R"("mtu_bytes":1472)", R"("mtu_bytes":1e99)"},
      {R"("mtu_bytes":1472)", R"("mtu_bytes":-5)"},
      {R"("listen_port":39540)", R"("listen_port":-1)"},
      {R"("avatar":null)", R"("avatar":0.5)"}};
  for (const auto& [from, to] : changes) {
    std::string changed = text;
    const auto at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from << " in " << text;
    changed.replace(at, from.size(), to);
    EXPECT_FALSE(parse_live_settings(changed, "live.sqlite")) << to;
  }
}

TEST(LiveRequests, AreRestoredAndAreEmptyByDefault) {
  EXPECT_EQ(live_requests_text({}), "");
  EXPECT_EQ(live_requests_text({{{std::nullopt, false}}}), "");
  LiveRequests asked;
  asked.streams.resize(2);
  asked.streams[1] = {live::VmcPeriods{1, 2, 3}, true};
  const auto back = parse_live_requests(live_requests_text(asked), "take");
  ASSERT_TRUE(back);
  ASSERT_EQ(back->streams.size(), 2U);
  EXPECT_FALSE(back->streams[0].periods);
  EXPECT_EQ(back->streams[1].periods->bone, 3);
  EXPECT_TRUE(back->streams[1].info);
  EXPECT_FALSE(back->behind);
  LiveRequests late;
  late.behind = true;
  const auto late_back = parse_live_requests(live_requests_text(late), "take");
  ASSERT_TRUE(late_back);
  EXPECT_TRUE(late_back->behind);
  EXPECT_FALSE(parse_live_requests("{\"vmc\":7}", "take"));
  EXPECT_FALSE(parse_live_requests("{\"vmc\":[],\"behind\":7}", "take"));
}

// A chain that starts later receives the requests from before its start.
TEST(KeptPeriods, AreThoseAskedForLast) {
  KeptPeriods kept;
  LiveRequests nothing;
  kept.add_to(nothing);
  EXPECT_EQ(live_requests_text(nothing), "");
  kept.apply({{{}, {live::VmcPeriods{1, 1, 1}, true}}});
  kept.apply({{{}, {live::VmcPeriods{2, 3, 4}, false}}});
  kept.apply({});
  LiveRequests later;
  kept.add_to(later);
  ASSERT_EQ(later.streams.size(), 2U);
  EXPECT_FALSE(later.streams[0].periods);
  ASSERT_TRUE(later.streams[1].periods);
  EXPECT_EQ(later.streams[1].periods->bone, 4);
  EXPECT_FALSE(later.streams[1].info);
  LiveRequests newer{{{}, {live::VmcPeriods{5, 6, 7}, false}}};
  kept.add_to(newer);
  EXPECT_EQ(newer.streams[1].periods->bone, 7);
}

TEST(LiveRequests, KeepWhatIsDraggedToTheLastBit) {
  LiveRequests asked;
  EXPECT_TRUE(asked.add({"left hand", HandleAction::kMove, {0.1, 0.2, 0.3}}));
  EXPECT_TRUE(asked.add({"left hand", HandleAction::kMove, {0.1 / 3.0, 1e-17, -4.2}}));
  EXPECT_TRUE(asked.add({"hips", HandleAction::kStop, {}}));
  EXPECT_TRUE(asked.add({"left hand", HandleAction::kMove, {0.5, 0.6, 0.7}}));
  const auto back = parse_live_requests(live_requests_text(asked), "take");
  ASSERT_TRUE(back) << back.error().message();
  ASSERT_EQ(back->handles.size(), 3U) << "the last of movements counts";
  EXPECT_EQ(back->handles[0].id, "left hand");
  EXPECT_EQ(back->handles[0].p_in_world, glm::dvec3(0.1 / 3.0, 1e-17, -4.2));
  EXPECT_EQ(back->handles[1].action, HandleAction::kStop);
  EXPECT_EQ(back->handles[2].p_in_world, glm::dvec3(0.5, 0.6, 0.7));
}

TEST(LiveRequests, RefuseHandlesThatCannotBe) {
  for (const char* handle : {R"({"id":"hips","action":"jump"})",
                             R"({"id":"hips","action":"move"})",
                             R"({"id":"hips","action":"move","p_in_world":[0,1]})",
                             R"({"id":"hips","action":"move","p_in_world":[0,1,1e5]})",
                             R"({"id":"hips","action":"move","p_in_world":[0,1,null]})",
                             R"({"id":7,"action":"stop"})",
                             "7"}) {
    const std::string text = std::string(R"({"vmc":[],"handles":[)") + handle + "]}";
    EXPECT_FALSE(parse_live_requests(text, "take")) << text;
  }
  LiveRequests asked;
  for (std::size_t i = 0; i < LiveRequests::kMaxHandles; ++i) {
    EXPECT_TRUE(asked.add({"hips", HandleAction::kStop, {}}));
  }
  EXPECT_FALSE(asked.add({"hips", HandleAction::kStop, {}}));
}

TEST(PlanStreams, PutsTargetsOfOneKindTogether) {
  LiveSettings plan;
  plan.avatars = {"man.vrm", "robot.glb"};
  std::vector<StreamTargets> targets;
  const Status ok = plan_streams(
      {"127.0.0.1", "192.168.1.7:5000", "robot=localhost:41", "man.vrm=127.0.0.1:40000"},
      live::VmcRest::kVrm0,
      std::nullopt,
      plan,
      targets);
  ASSERT_TRUE(ok) << ok.error().message();
  ASSERT_EQ(plan.streams.size(), 3U);
  EXPECT_EQ(plan.streams[0].avatar, 0U);
  EXPECT_FALSE(plan.streams[0].mtu_bytes) << "one bundle a frame on this machine";
  ASSERT_EQ(targets[0].addresses.size(), 2U);
  EXPECT_EQ(targets[0].addresses[0].port, 39539);
  EXPECT_EQ(targets[0].addresses[1].port, 40000);
  EXPECT_EQ(plan.streams[1].mtu_bytes, 1472);
  EXPECT_EQ(plan.streams[2].avatar, 1U);
}

}  // namespace
}  // namespace marey::app
