// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Bad command lines, files of other kinds, empty files, folders and missing files: each
// ends with one plain line.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/printable.h"
#include "recordings/base/atomic_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

struct BadCommand {
  std::vector<std::string> arguments;
  int exit_code = 2;
  std::string part;  ///< A part of the message.
};

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// A folder with files whose content differs from their extension.
class PlainMessages : public ::testing::Test {
 protected:
  PlainMessages() {
    const std::string glb("glTF\2\0\0\0\xff\xfe\xfd\xfc", 12);
    write("glb.bvh", glb);
    write("glb.c3d", glb);
    write("picture.glb", "\x89PNG\r\n\x1a\n\x1b[31m");
    write("motion.glb", "HIERARCHY\nROOT hips\n");
    write("bytes.bvh", "\x1b[31m\xff\xfe\n");
    write("bytes.trc", "\x1b[31m\xff\xfe\n");
    write("notes.txt", "notes\n");
    for (const char* name :
         {"empty.bvh", "empty.glb", "empty.c3d", "empty.trc", "empty.toml"}) {
      write(name, "");
    }
    write("cameras.toml", "[cam0]\nname = \"cam0\"\nmatrix = [[1.0, 0.0, 0.0]]\n");
    write("plan.toml", "format = 1\ntag_size_m = 0.08\n[[camera]]\nname = \"cam0\"\n");
    write("walk.bvh",
          "HIERARCHY\nROOT hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation "
          "Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: "
          "0.1\n0 0 0\n");
    write("walk.trc", "PathFileType\n");
    fs::create_directory(folder_ / "folder");
    fs::create_directory(folder_ / "folder.bvh");
    fs::create_directory(folder_ / "folder.c3d");
    fs::create_directory(folder_ / "folder.glb");
  }

  /// Expects the exit code, one line with one cause and one next step, no byte that a
  /// terminal must not receive, and no new file.
  void expect(const BadCommand& bad) const {
    std::string line;
    for (const std::string& word : bad.arguments) line += word + " ";
    SCOPED_TRACE(line);
    const std::vector<fs::path> before = files_below(folder_.path());
    const ProgramRun run = run_program(
        program(), bad.arguments, {.folder = folder_.path(), .interrupt_at = ""});
    EXPECT_EQ(run.exit_code, bad.exit_code) << run.err;
    EXPECT_TRUE(run.err.starts_with("error: ")) << run.err;
    EXPECT_EQ(count_of(run.err, "\n"), 1U) << run.err;
    EXPECT_EQ(count_of(run.err, "Next:"), 1U) << run.err;
    EXPECT_NE(run.err.find(bad.part), std::string::npos) << bad.part << "\n" << run.err;
    const std::string text = run.err.substr(0, run.err.find('\n'));
    EXPECT_EQ(printable(text), text);
    EXPECT_EQ(files_below(folder_.path()), before);
  }

 private:
  void write(const std::string& name, const std::string& bytes) const {
    EXPECT_TRUE(recordings::write_file(folder_ / name, bytes));
  }

  ScratchFolder folder_;
};

TEST_F(PlainMessages, NameAMissingArgumentByItsUpperCaseWord) {
  for (const BadCommand& bad : std::vector<BadCommand>{
           {{"view"}, 2, "FILE is missing"},
           {{"inspect"}, 2, "FILE is missing"},
           {{"convert"}, 2, "INPUT is missing"},
           {{"convert", "walk.bvh"}, 2, "OUTPUT is missing"},
           {{"repair", "--out", "a.trc"}, 2, "INPUT is missing"},
           {{"fit", "--out", "a"}, 2, "INPUT is missing"},
           {{"plan", "--out", "a"}, 2, "PLAN is missing"},
           {{"process", "--out", "a"}, 2, "SESSION is missing"},
           {{"live"}, 2, "SESSION is missing"},
           {{"replay"}, 2, "TAKE is missing"},
           {{"listen"}, 2, "BODY is missing"},
           {{"adapt", "--out", "a.bvh"}, 2, "MOTION is missing"},
           {{"jump", "--out", "a.bvh"}, 2, "MOTION is missing"},
           {{"retarget", "walk.bvh", "--out", "a"}, 2, "AVATAR is missing"},
           {{"listen", "walk.bvh"}, 2, "no output is given"}}) {
    expect(bad);
  }
}

TEST_F(PlainMessages, StateAllowedValues) {
  const std::string vmc = "--vmc-mtu must be 0 or a whole number from 104 to 65507, not ";
  for (const BadCommand& bad : std::vector<BadCommand>{
           {{"live", "a", "--vmc-mtu", "99"}, 2, vmc + "99"},
           {{"live", "a", "--vmc-mtu", "10"}, 2, vmc + "10"},
           {{"live", "a", "--vmc-mtu", "1472.5"}, 2, vmc + "1472.5"},
           {{"live", "a", "--vmc-mtu", "large"}, 2, vmc + "\"large\""},
           {{"plan", "plan.toml", "--out", "a", "--height", "nan"},
            2,
            "--height must be a number from 0.3 to 10, not nan"},
           {{"view", "walk.bvh", "--port", "70000"},
            2,
            "--port must be a whole number from 0 to 65535, not 70000"},
           {{"adapt", "walk.bvh", "--out", "a.bvh", "--method", "magic"},
            2,
            "--method must be strict or thesis, not \"magic\""},
           {{"inspect", "walk.bvh", "--json=maybe"}, 2, "--json takes no value"},
           {{"repair", "walk.trc", "-o", "a.trc", "--max-sigma", "11"},
            2,
            "--max-sigma must be a number from 0.001 to 10, not 11"},
           {{"live", "a", "--vmc-listen", "39540", "--vmc-send-only"},
            2,
            "--vmc-listen and --vmc-send-only cannot be used together"},
           {{"live", "a", "--vmc-listen", "39540", "--vmc-deaf"},
            2,
            "--vmc-listen and --vmc-deaf cannot be used together"},
           {{"tags", "--out", "a.pdf", "--ids", "x", "--size", "8cm"}, 2, "\"x\""},
           {{"tags", "--out", "a.pdf", "--ids", "1", "--size", "8"}, 2, "has no unit"},
           {{"tags", "--out", "a.pdf", "--ids", "1", "--size", "8cm", "--page", "B9"},
            2,
            "is not a page size"},
           {{"plan", "plan.toml", "--out", "a", "--tag", "90"}, 2, "has no unit"},
           {{"repair", "walk.trc", "--out"}, 2, "--out has no value"},
           {{"repair", "walk.trc", "--out", "a.trc", "--out", "b.trc"},
            2,
            "--out is given more than once"}}) {
    expect(bad);
  }
}

TEST_F(PlainMessages, NameTheNearestNameOrTheHelp) {
  for (const BadCommand& bad : std::vector<BadCommand>{
           {{"retargt"}, 2, "perhaps you mean \"retarget\"; "},
           {{"xyzzy"}, 2, "there is no such command. Next: "},
           {{"live", "a", "--vmc-restt", "raw"}, 2, "perhaps you mean \"--vmc-rest\"; "},
           {{"repair", "walk.trc", "--output", "a.trc"}, 2, "mean \"--out\"; "},
           {{"live", "a", "--frobnicate"},
            2,
            "there is no option --frobnicate. Next: "}}) {
    expect(bad);
  }
  const ProgramRun run = run_program(program(), {"live", "a", "--frobnicate"});
  EXPECT_EQ(run.err.find("choose one of"), std::string::npos) << run.err;
  EXPECT_EQ(count_of(run.err, "--help"), 1U) << run.err;
}

TEST_F(PlainMessages, AreJsonIfProgressIs) {
  const ProgramRun run = run_program(program(), {"--progress", "json", "view"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(run.err.starts_with("{\"error\":")) << run.err;
}

TEST_F(PlainMessages, NameFilesOfOtherKinds) {
  for (const BadCommand& bad : std::vector<BadCommand>{
           {{"convert", "glb.bvh", "a.npz"}, 3, "this is a glTF or VRM file, not a BVH"},
           {{"inspect", "glb.c3d"}, 3, "this is a glTF or VRM file, not a C3D file"},
           {{"inspect", "picture.glb"}, 3, "this is a picture, not a glTF or VRM file"},
           {{"inspect", "motion.glb"}, 3, "this is a BVH motion, not a glTF or VRM file"},
           {{"inspect", "bytes.bvh"}, 3, "\"?[31m??\""},
           {{"inspect", "bytes.trc"}, 3, "this is not a TRC file"},
           {{"adapt", "notes.txt", "--out", "a.bvh"}, 3, "one of these kinds: .bvh"},
           {{"retarget", "cameras.toml", "walk.bvh", "--out", "a"},
            3,
            "one of these kinds: .bvh"},
           {{"process", "cameras.toml", "--out", "a"},
            3,
            "this is a calibration, not a session"},
           {{"live", "plan.toml"}, 3, "this is a plan, not a session"}}) {
    expect(bad);
  }
}

TEST_F(PlainMessages, CallAnEmptyFileEmpty) {
  for (const char* name :
       {"empty.bvh", "empty.glb", "empty.c3d", "empty.trc", "empty.toml"}) {
    expect({{"inspect", name}, 3, std::string(name) + ": the file is empty"});
  }
  expect({{"process", "empty.toml", "--out", "a"}, 3, "the file is empty"});
}

TEST_F(PlainMessages, RefuseAFolderInPlaceOfAFile) {
  const std::string folder = "this is a folder, not a file";
  for (const BadCommand& bad : std::vector<BadCommand>{
           {{"fit", "folder", "--out", "a"}, 3, folder},
           {{"repair", "folder", "--out", "a.trc"}, 3, folder},
           {{"retarget", "folder", "walk.bvh", "--out", "a"}, 3, folder},
           {{"adapt", "folder", "--out", "a.bvh"}, 3, folder},
           {{"listen", "folder", "--out", "a.bvh"}, 3, folder},
           {{"convert", "folder", "a.bvh"}, 3, "a folder is not converted"},
           {{"convert", "walk.bvh", "folder.bvh"}, 3, "the result is one file"},
           {{"adapt", "walk.bvh", "--out", "folder"}, 3, "the result is one file"},
           {{"jump", "walk.bvh", "--out", "folder"}, 3, "the result is one file"},
           {{"repair", "walk.trc", "--out", "folder.c3d"}, 3, "the result is one file"},
           {{"mannequin", "--out", "folder.glb"}, 3, "the result is one file"},
           {{"replay", "walk.bvh"}, 3, "this is a file, not the folder of a take"}}) {
    expect(bad);
  }
}

TEST_F(PlainMessages, HaveOneWordingForAMissingFile) {
  const std::string missing =
      "the file does not exist. Next: check the name and the folder.";
  for (const BadCommand& bad : std::vector<BadCommand>{
           {{"view", "gone.bvh"}, 3, missing},
           {{"inspect", "gone.bvh"}, 3, missing},
           {{"convert", "gone.bvh", "a.npz"}, 3, missing},
           {{"repair", "gone.trc", "--out", "a.trc"}, 3, missing},
           {{"fit", "gone.trc", "--out", "a"}, 3, missing},
           {{"adapt", "gone.bvh", "--out", "a.bvh"}, 3, missing},
           {{"jump", "gone.bvh", "--out", "a.bvh"}, 3, missing},
           {{"retarget", "gone.bvh", "walk.bvh", "--out", "a"}, 3, missing},
           {{"listen", "gone.vrm", "--out", "a.bvh"}, 3, missing},
           {{"replay", "gone"}, 3, missing},
           {{"process", "gone.toml", "--out", "a"}, 3, missing},
           {{"plan", "gone.toml", "--out", "a"}, 3, missing},
           {{"demo", "--sample", "gone.toml", "--out", "a"}, 3, missing}}) {
    expect(bad);
  }
}

TEST_F(PlainMessages, RefuseTheKindOfAResultBeforeTheWork) {
  expect({{"repair", "gone.trc", "--out", "a.txt"}, 3, "a.txt: labelled markers"});
}

}  // namespace
}  // namespace marey::testing
