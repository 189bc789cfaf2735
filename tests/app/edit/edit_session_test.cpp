// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The document behind the edit page, without a network. Truth: the recipe that each step
// should give, and the results of rendering it from nothing.
#include "app/edit/edit_session.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/edit/edit_recipe_file.h"
#include "tests/app/edit/opened_edit.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

TEST(EditSession, MakesARecipeForAMotionAndKeepsItAcrossRestarts) {
  OpenedEdit edit;
  edit.open();
  EXPECT_EQ(edit.number(), 1);
  EXPECT_TRUE(fs::exists(edit.recipe()));
  EXPECT_EQ(edit.session->recipe().sources[0].sha256.size(), 64U);
  EXPECT_EQ(edit.session->sources()[0].frames, 121);
  ASSERT_EQ(changed(edit, {inserted(0, "do = \"cut@1\"\nfrom_s = 0.5\n")}), 2);
  edit.session->wait_until_idle();
  EXPECT_EQ(edit.reports.rendered.back(), 2);
  EXPECT_EQ(edit.reports.frames, 91);
  EXPECT_EQ(edit.reports.last_progress.state, EditProgress::State::kDone);
  const std::string text = edit.session->recipe_text();
  EXPECT_EQ(*recordings::read_file(edit.recipe()), text);
  edit.open();
  EXPECT_EQ(edit.number(), 2) << "nothing changed in between";
  EXPECT_EQ(edit.session->recipe_text(), text);
  EXPECT_TRUE(edit.session->can_undo());
}

TEST(EditSession, DeclinesAChangeOfAnOlderRevision) {
  OpenedEdit edit;
  edit.open();
  const live::OpsPatch patch{inserted(0, "do = \"mirror@1\"\n")};
  ASSERT_EQ(changed(edit, patch), 2);
  const auto outcome = edit.session->edit({1, patch});
  ASSERT_TRUE(std::holds_alternative<EditStale>(outcome));
  EXPECT_EQ(std::get<EditStale>(outcome).newest, 2);
  EXPECT_TRUE(std::holds_alternative<EditStale>(edit.session->undo({1})));
  EXPECT_TRUE(std::holds_alternative<EditStale>(edit.session->preview({}, {1})));
  EXPECT_EQ(edit.number(), 2);
  EXPECT_EQ(edit.session->recipe().ops.size(), 1U);
}

TEST(EditSession, UndoesAndRedoesAsNewRevisions) {
  OpenedEdit edit;
  edit.open();
  const std::string first = edit.session->recipe_text();
  ASSERT_EQ(changed(edit, {inserted(0, "do = \"mirror@1\"\n")}), 2);
  ASSERT_EQ(changed(edit, {inserted(1, "do = \"cut@1\"\nto_s = 1.0\n")}), 3);
  const std::string last = edit.session->recipe_text();
  EXPECT_TRUE(std::holds_alternative<EditAccepted>(edit.session->undo({3})));
  EXPECT_TRUE(std::holds_alternative<EditAccepted>(edit.session->undo({4})));
  EXPECT_EQ(edit.session->recipe_text(), first);
  EXPECT_TRUE(std::holds_alternative<Error>(edit.session->undo({5})));
  edit.open();
  EXPECT_TRUE(std::holds_alternative<EditAccepted>(edit.session->redo({5})));
  EXPECT_TRUE(std::holds_alternative<EditAccepted>(edit.session->redo({6})));
  EXPECT_EQ(edit.session->recipe_text(), last);
  EXPECT_TRUE(std::holds_alternative<Error>(edit.session->redo({7})));
  EXPECT_EQ(edit.number(), 7);
  edit.session->wait_until_idle();
  EXPECT_EQ(edit.reports.frames, 61);
}

TEST(EditSession, UndoesAndRedoes500RandomGestures) {
  OpenedEdit edit;
  edit.open();
  const std::string first = edit.session->revision().sha256;
  std::uint64_t state = 5;
  const auto below = [&state](std::size_t limit) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<int>((state >> 33U) % limit);
  };
  using Kind = live::OpsPatchStep::Kind;
  const std::vector<std::string> ops{"do = \"mirror@1\"\n",
                                     "do = \"tag@1\"\ntext = \"gänge\"\n",
                                     "do = \"cut@1\"\nfrom_frame = 1\n",
                                     "do = \"plant@1\"\noff = true\n"};
  for (int i = 0; i < 500; ++i) {
    const std::size_t count = edit.session->recipe().ops.size();
    live::OpsPatchStep step =
        inserted(below(count + 1), ops[static_cast<std::size_t>(i) % ops.size()]);
    if (count >= 12 || (count > 0 && below(2) == 0)) {
      step.kind = static_cast<Kind>(1 + below(4));
      step.index = below(count);
      step.to = below(count);
      step.off = below(2) == 0;
    }
    ASSERT_EQ(changed(edit, {step}), i + 2);
  }
  const std::string last = edit.session->revision().sha256;
  for (int i = 0; i < 500; ++i) (void)edit.session->undo({edit.number()});
  EXPECT_EQ(edit.session->revision().sha256, first);
  EXPECT_FALSE(edit.session->can_undo());
  edit.open();
  for (int i = 0; i < 500; ++i) (void)edit.session->redo({edit.number()});
  EXPECT_EQ(edit.session->revision().sha256, last);
  EXPECT_EQ(edit.number(), 1501);
}

TEST(EditSession, AppliesStepsInTheirOrder) {
  OpenedEdit edit;
  edit.open();
  using Kind = live::OpsPatchStep::Kind;
  live::OpsPatchStep moved{Kind::kMove, 2, 0, false, {}};
  live::OpsPatchStep off{Kind::kToggle, 1, 0, true, {}};
  live::OpsPatchStep removed{Kind::kRemove, 2, 0, false, {}};
  live::OpsPatchStep replaced{
      Kind::kReplace, 0, 0, false, "[[op]]\ndo = \"tag@1\"\ntext = \"b\"\n"};
  ASSERT_EQ(changed(edit,
                    {inserted(0, "do = \"mirror@1\"\n"),
                     inserted(1, "do = \"plant@1\"\n"),
                     inserted(2, "do = \"tag@1\"\ntext = \"a\"\n"),
                     moved,
                     off,
                     removed,
                     replaced}),
            2);
  const auto& ops = edit.session->recipe().ops;
  ASSERT_EQ(ops.size(), 2U);
  EXPECT_EQ(std::get<TagOp>(ops[0].parameters).text, "b");
  EXPECT_TRUE(std::holds_alternative<MirrorOp>(ops[1].parameters));
  EXPECT_TRUE(ops[1].off);
  edit.session->wait_until_idle();
}

TEST(EditSession, DeclinesPatchesAndChangesNothing) {
  OpenedEdit edit;
  edit.open();
  using Kind = live::OpsPatchStep::Kind;
  const std::vector<std::pair<live::OpsPatch, std::string>> cases{
      {{inserted(1, "do = \"mirror@1\"\n")}, "does not exist"},
      {{{Kind::kRemove, 0, 0, false, {}}}, "does not exist"},
      {{inserted(0, "do = \"mirror@1\"\n"), {Kind::kMove, 0, 1, false, {}}},
       "does not exist"},
      {{inserted(0, "do = \"mirrow@1\"\n")}, "no operation \"mirrow\""},
      {{inserted(0, "do = \"cut@1\"\nform_s = 1\n")}, "form_s"},
      {{inserted(0, "do = \"cut@1\"\nfrom_s = 2\nto_s = 1\n")}, "the operation"},
      {{inserted(0, "do = \"splice@1\"\nsource = \"/etc/passwd\"\n")}, "/etc/passwd"},
      {{inserted(0, "do = \"retarget@1\"\navatar = \"/etc/passwd\"\n")}, "no avatar"}};
  for (const auto& [patch, reason] : cases) {
    std::string message;
    EXPECT_EQ(changed(edit, patch, &message), -1);
    EXPECT_NE(message.find(reason), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_EQ(edit.number(), 1);
}

TEST(EditSession, KeepsTheOlderMotionIfAnOperationFails) {
  OpenedEdit edit;
  edit.open();
  edit.session->wait_until_idle();
  ASSERT_EQ(changed(edit,
                    {inserted(0, "do = \"mirror@1\"\n"),
                     inserted(1, "do = \"cut@1\"\nfrom = \"absent\"\n")}),
            2);
  edit.session->wait_until_idle();
  EXPECT_EQ(edit.reports.rendered, std::vector<int>{1});
  EXPECT_EQ(edit.reports.last_progress.state, EditProgress::State::kFailed);
  EXPECT_EQ(edit.reports.last_progress.failed_op, 1);
  EXPECT_NE(edit.reports.last_progress.error.find("absent"), std::string::npos);
  EXPECT_EQ(edit.number(), 2) << "the recipe is kept, and can be undone";
}

TEST(EditSession, PreviewsWithoutARevision) {
  OpenedEdit edit;
  edit.open();
  ASSERT_EQ(changed(edit, {inserted(0, "do = \"cut@1\"\nfrom_s = 0.5\n")}), 2);
  edit.session->wait_until_idle();
  live::PreviewRequest request{
      2, {inserted(1, "do = \"cut@1\"\nfrom_s = 0.5\n")}, {}, {}, FrameRange{10, 19}};
  ASSERT_TRUE(std::holds_alternative<EditAccepted>(
      edit.session->preview({7, "preview", "a"}, request)));
  edit.session->wait_until_idle();
  EXPECT_EQ(edit.reports.previews, std::vector<std::string>{"a"});
  EXPECT_EQ(edit.reports.preview_frames, 61);
  ASSERT_EQ(edit.reports.preview.blocks.size(), 1U);
  EXPECT_NE(edit.reports.preview.json.find("\"span\":[10,19]"), std::string::npos);
  EXPECT_EQ(edit.number(), 2);
  request.patch.clear();
  request.until = 0;
  ASSERT_TRUE(std::holds_alternative<EditAccepted>(
      edit.session->preview({7, "render", "b"}, request)));
  edit.session->wait_until_idle();
  EXPECT_EQ(edit.reports.preview_frames, 121) << "as the first operation receives it";
}

TEST(EditSession, ReplacesWaitingPreviewsOfThePage) {
  OpenedEdit edit;
  edit.open();
  for (int i = 0; i < 40; ++i) {
    const live::PreviewRequest request{
        1,
        {inserted(0, "do = \"cut@1\"\nto_frame = " + std::to_string(20 + i) + "\n")},
        {},
        {},
        {}};
    (void)edit.session->preview({3, "preview", std::to_string(i)}, request);
    (void)edit.session->preview({4, "preview", "other " + std::to_string(i)}, request);
  }
  edit.session->wait_until_idle();
  ASSERT_GE(edit.reports.previews.size(), 2U);
  EXPECT_EQ(edit.reports.previews.back(), "other 39");
  EXPECT_EQ(edit.reports.previews[edit.reports.previews.size() - 2], "39");
  EXPECT_EQ(edit.reports.preview_frames, 60);
}

TEST(EditSession, ExportsTheBytesOfTheRecipeRenderedFromNothing) {
  OpenedEdit edit;
  edit.open();
  ASSERT_EQ(changed(edit, {inserted(0, "do = \"cut@1\"\nfrom_s = 0.5\n")}), 2);
  ASSERT_EQ(changed(edit,
                    {inserted(1, "do = \"retime@1\"\nspeed = 0.8\n"),
                     inserted(2, "do = \"mirror@1\"\n")}),
            3);
  ASSERT_TRUE(
      std::holds_alternative<EditAccepted>(edit.session->write({1, "export", "x"}, {3})));
  edit.session->wait_until_idle();
  ASSERT_TRUE(edit.reports.failed.empty()) << edit.reports.failed["x"];
  ASSERT_GE(edit.reports.exported.files.size(), 3U);
  // As the command line does it, without a cache.
  const auto recipe = recordings::read_edit_recipe(edit.recipe());
  ASSERT_TRUE(recipe) << recipe.error().message();
  const auto files =
      read_edit_files(*recipe, {edit.folder.path(), edit.recipe().string(), false});
  ASSERT_TRUE(files) << files.error().message();
  edit::RenderOptions options;
  options.recipe_file = edit.recipe().string();
  const auto rendered = edit::render(*recipe, files->inputs, options);
  ASSERT_TRUE(rendered) << rendered.error().message();
  EditOutput output = edit.options().output;
  output.out = edit.folder / "again";
  const auto written = write_edit(
      *recipe, *files, *rendered, measure_edit(*recipe, *files, *rendered), output);
  ASSERT_TRUE(written) << written.error().message();
  ASSERT_EQ(written->size(), edit.reports.exported.files.size());
  for (std::size_t i = 0; i < written->size(); ++i) {
    EXPECT_EQ(*recordings::read_file((*written)[i]),
              *recordings::read_file(edit.reports.exported.files[i]))
        << (*written)[i];
  }
}

TEST(EditSession, MakesARevisionOfARecipeThatAnotherProgramChanged) {
  OpenedEdit edit;
  edit.open();
  ASSERT_EQ(changed(edit, {inserted(0, "do = \"mirror@1\"\n")}), 2);
  const std::string before = edit.session->recipe_text();
  edit.session.reset();
  std::ofstream(edit.recipe(), std::ios::app) << "[[op]]\ndo = \"plant@1\"\n";
  edit.open();
  EXPECT_EQ(edit.number(), 3);
  EXPECT_EQ(edit.session->revision().cause, EditCause::kFile);
  EXPECT_EQ(edit.session->recipe().ops.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<EditAccepted>(edit.session->undo({3})));
  EXPECT_EQ(edit.session->recipe_text(), before);
}

TEST(EditSession, DeclinesASecondSessionOnOneRecipe) {
  OpenedEdit edit;
  edit.open();
  const auto second = EditSession::open(edit.options(), edit.reports);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message().find("is open in another marey"), std::string::npos);
}

TEST(EditSession, DeclinesASourceThatChanged) {
  OpenedEdit edit;
  edit.open();
  edit.session.reset();
  std::ofstream(edit.clip(), std::ios::app) << "\n";
  const auto again = EditSession::open(edit.options(), edit.reports);
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message().find("another content"), std::string::npos);
}

}  // namespace
}  // namespace marey::app
