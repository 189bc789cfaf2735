// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/trc.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/recordings/markers/has_note.h"

namespace marey::recordings {
namespace {

const std::string kKeys =
    "PathFileType\t4\t(X/Y/Z)\ta.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
    "OrigDataStartFrame\tOrigNumFrames\n";
const std::string kLabels =
    "Frame#\tTime\tA\t\t\tB\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n";

std::string head(const std::string& values = "100\t100\t2\t2\tmm\t100\t1\t2") {
  return kKeys + values + "\n" + kLabels;
}

const std::string kRows =
    "1\t0.00\t1000\t2000\t-3000\t4\t5\t6\n"
    "2\t0.01\t1001.5\t2000\t-3000\t4\t5\t6.25\n";

MarkerFile read(const std::string& text) {
  auto file = parse_trc(text, "a.trc", {.up = FileAxis::kPlusY, .unit = {}});
  EXPECT_TRUE(file) << file.error().message();
  return file ? *std::move(file) : MarkerFile{};
}

std::string trc_refusal(const std::string& text) {
  const auto file = parse_trc(text, "a.trc");
  return file ? "no refusal" : file.error().message();
}

TEST(Trc, HoldsLabelledMarkersInMillimetres) {
  const MarkerFile file = read(head() + kRows);
  EXPECT_EQ(file.tracks.labels, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(file.tracks.rate.hz, 100.0);
  ASSERT_EQ(file.tracks.frames(), 2U);
  EXPECT_EQ(file.tracks.at(1, 0)->p_in_world, glm::dvec3(1.0015, 2.0, -3.0));
  EXPECT_EQ(file.tracks.at(1, 1)->p_in_world, glm::dvec3(0.004, 0.005, 0.00625));
  EXPECT_TRUE(file.notes.empty()) << file.notes[0];
}

TEST(Trc, IsReadAsItWasWrittenToTheLastBit) {
  const MarkerFile file = read(head() + kRows);
  const std::string text = trc_text(file.tracks, file.axes, "a.trc");
  const MarkerFile again = read(text);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(again.tracks.samples[i]->p_in_world, file.tracks.samples[i]->p_in_world);
  }
  EXPECT_EQ(trc_text(again.tracks, again.axes, "a.trc"), text);
  EXPECT_NE(text.find("1001.5\t2000\t-3000\t4\t5\t6.25\n"), std::string::npos) << text;
}

TEST(Trc, LineEndsOfEverySystemAreTheSame) {
  const std::string text = head() + kRows;
  for (const std::string end : {"\r\n", "\r"}) {
    std::string other;
    for (const char c : text) other += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(read(other).tracks.frames(), 2U);
  }
  EXPECT_EQ(read("\xEF\xBB\xBF" + text).tracks.frames(), 2U);
}

TEST(Trc, AcceptsManySpellingsOfAMarkerNotSeen) {
  for (const char* missing : {"\t\t",
                              "NaN\tnan\tNAN",
                              " NaN\t -nan\t nan(ind)",
                              "1.#QNAN\t1.#IND\t-1.#IND",
                              "inf\t-Inf\tInfinity",
                              "0\t0.0\t-0"}) {
    const MarkerFile file =
        read(head() + "1\t0\t" + missing + "\t4\t5\t6\n2\t0.01\t1\t2\t3\t4\t5\t6\n");
    EXPECT_FALSE(file.tracks.at(0, 0)) << missing;
    EXPECT_TRUE(file.tracks.at(0, 1)) << missing;
    EXPECT_TRUE(file.tracks.at(1, 0)) << missing;
  }
}

TEST(Trc, ReportsRowsThatEndEarlyAndSkipsBlankLines) {
  const MarkerFile file = read(head() + "1\t0.00\t1\t2\t3\n\t\t\n2\t0.01\n");
  EXPECT_EQ(file.tracks.frames(), 2U);
  EXPECT_TRUE(file.tracks.at(0, 0));
  EXPECT_FALSE(file.tracks.at(0, 1));
  EXPECT_TRUE(has_note(
      file, "rows that end before the last marker; the rest counts as not seen: 2"));
}

TEST(Trc, ExtraTabsAndBlankColumnsDoNotMatter) {
  const std::string shifted =
      kKeys + "  100.0\t\t  100.0\t\t 2\t\t 2\t\t mm\n" +
      "Frame#\tTimes\t\tA\t\tB\n\t\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\t\n" +
      "1\t0\t1\t2\t3\t4\t5\t6\t\t\t\t\n2\t0.01\t1\t2\t3\t4\t5\t6\t\n";
  const MarkerFile file = read(shifted);
  EXPECT_EQ(file.tracks.labels, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(file.axes.unit, "mm");
  EXPECT_TRUE(file.notes.empty()) << file.notes[0];
}

TEST(Trc, CellsMayLieBetweenOtherMarksThanTabs) {
  const std::string text =
      head() + "1\t0.00\t\t\t\t4\t5\t6\n" + kRows.substr(kRows.find('\n') + 1);
  for (const char mark : {',', ';'}) {
    std::string other = text;
    std::replace(other.begin(), other.end(), '\t', mark);
    const MarkerFile file = read(other);
    EXPECT_EQ(file.tracks.labels, (std::vector<std::string>{"A", "B"})) << mark;
    ASSERT_EQ(file.tracks.frames(), 2U);
    EXPECT_FALSE(file.tracks.at(0, 0));
    EXPECT_EQ(file.tracks.at(1, 1)->p_in_world.z, 0.00625);
    EXPECT_TRUE(file.notes.empty()) << file.notes[0];
  }
  // If words are separated by blanks, none may be missing.
  std::string words = kKeys + "100 100 1 2 mm\nFrame# Time A B\n1 0 1 2 3 4 5 6\n";
  EXPECT_EQ(read(words).tracks.at(0, 1)->p_in_world.x, 0.004);
  words += "2 0.01 1 2 3\n";
  EXPECT_EQ(trc_refusal(words),
            "a.trc:6: the row has 5 numbers instead of 8. Next: correct the line, or "
            "export the file again.");
}

TEST(Trc, ReportsCommasForDecimalPoints) {
  const MarkerFile file = read(head() + "1\t0,00\t1,5\t2\t3\t4\t5\t6\n");
  EXPECT_EQ(file.tracks.at(0, 0)->p_in_world.x, 0.0015);
  EXPECT_TRUE(has_note(file, "numbers with a comma for a decimal point: 2"));
}

TEST(Trc, ReportsWrongCountsOfTheHeader) {
  const MarkerFile file = read(head("100\t100\t99\t3\tmm\t100\t1\t2") + kRows);
  EXPECT_TRUE(has_note(file, "the header states 3 markers, and there are 2"));
  EXPECT_TRUE(has_note(file, "the header states 99 frames, and there are 2"));
}

TEST(Trc, MarkersWithoutALabelGetOne) {
  const std::string text = kKeys + "100\t100\t1\t3\tmm\t100\t1\t1\n" +
                           "Frame#\tTime\tA\t\t\t\t\t\tA\t\t\n\n" +
                           "1\t0\t1\t2\t3\t4\t5\t6\t7\t8\t9\n";
  const MarkerFile file = read(text);
  EXPECT_EQ(file.tracks.labels, (std::vector<std::string>{"A", "unnamed_2", "A_2"}));
  EXPECT_EQ(file.tracks.at(0, 2)->p_in_world.x, 0.007);
}

TEST(Trc, PrefersTheTimesOfTheRowsToTheRateOfTheHeader) {
  const MarkerFile file = read(
      head("250\t250\t3\t2\tmm\t250\t1\t3") +
      "1\t0\t1\t2\t3\t4\t5\t6\n2\t0.04\t1\t2\t3\t4\t5\t6\n3\t0.08\t1\t2\t3\t4\t5\t6\n");
  EXPECT_EQ(file.tracks.rate.hz, 25.0);
  EXPECT_TRUE(has_note(file, "DataRate is 250 Hz, the times 25 Hz"));
}

TEST(Trc, FramesThatAreLeftOutAreThereWithoutMarkers) {
  const MarkerFile file =
      read(head("100\t100\t2\t2\tmm\t100\t101\t2") +
           "101\t0.50\t1\t2\t3\t4\t5\t6\n104\t0.53\t1\t2\t3\t4\t5\t6\n");
  ASSERT_EQ(file.tracks.frames(), 4U);
  EXPECT_EQ(file.tracks.first_frame, 101);
  EXPECT_EQ(file.tracks.start_s, 0.5);
  EXPECT_FALSE(file.tracks.at(2, 0));
  EXPECT_TRUE(file.tracks.at(3, 0));
  EXPECT_TRUE(has_note(file, "2 frames are missing"));
}

TEST(Trc, AUnitThatIsMissingIsFound) {
  const MarkerFile file = read(head("100\t100\t2\t2\t100\t1\t2") +
                               "1\t0\t0.1\t1.7\t0\t0\t0.1\t0.1\n"
                               "2\t0.01\t0.1\t1.7\t0.1\t0\t0.1\t0.1\n");
  // Two markers are too few to estimate the size of a body.
  EXPECT_EQ(file.axes.unit_from, Evidence::kConvention);
  EXPECT_TRUE(has_note(file, "Units names no unit of length"));
}

TEST(Trc, OneFrameNeedsNoRate) {
  const MarkerFile file =
      read(head("0\t0\t1\t2\tmm\t0\t1\t1") + "1\t0\t1\t2\t3\t4\t5\t6\n");
  EXPECT_EQ(file.tracks.frames(), 1U);
  EXPECT_TRUE(has_note(file, "one frame needs none"));
}

TEST(Trc, FaultsAreRefusedWithTheirLine) {
  EXPECT_EQ(trc_refusal("frame,time\n1,2\n"),
            "a.trc:1: this is not a TRC file: it does not begin with PathFileType. Next: "
            "give a TRC file as OpenSim, Cortex or Vicon write it.");
  EXPECT_EQ(trc_refusal(""), "a.trc: the file is empty. Next: copy or export it again.");
  EXPECT_EQ(trc_refusal(":ASF\n"),
            "a.trc: this is an ASF skeleton, not a TRC file of markers. Next: give "
            "another file, or correct the extension of this one.");
  EXPECT_EQ(trc_refusal(kKeys),
            "a.trc:2: the file ends in its header. Next: give a TRC file as OpenSim, "
            "Cortex or Vicon write it.");
  EXPECT_EQ(
      trc_refusal(head() + "1\t0\t1\t2\tx7\t4\t5\t6\n"),
      "a.trc:7: column 5, a coordinate: \"x7\" is not a number. Next: correct the line, "
      "or export the file again.");
  EXPECT_EQ(
      trc_refusal(head() + kRows + "3\t0.02\t1\t2\t3\t4\t5\t6\t7\n"),
      "a.trc:9: the row has 9 cells; a frame, a time and 2 markers have room for 8. "
      "Next: correct the line, or export the file again.");
  EXPECT_EQ(trc_refusal(head() + kRows + "3\t0.005\t1\t2\t3\t4\t5\t6\n"),
            "a.trc:9: the time runs backwards. Next: correct the line, or export the "
            "file again.");
  EXPECT_EQ(trc_refusal(head("0\t0\t2\t2\tmm") + "1\t0\t\t\t\t\t\t\n2\t0\n"),
            "a.trc:3: neither DataRate nor the times give a frame rate. Next: set "
            "DataRate, in Hz.");
}

TEST(Trc, ATextThatEndsAnywhereIsReadOrRefused) {
  const std::string text = head() + kRows;
  for (std::size_t size = 0; size < text.size(); ++size) {
    const auto file = parse_trc(std::string_view(text).substr(0, size), "a.trc");
    if (!file) {
      EXPECT_EQ(file.error().message().find("a.trc:"), 0U);
    }
  }
}

// Many labels and short rows would need more memory than the file has bytes.
TEST(Trc, RowsThatAreTooShortForTheirLabelsDoNotFillTheMemory) {
  std::string text = kKeys + "100\t100\t0\t0\tmm\nFrame#\tTime";
  for (int i = 0; i < 20'000; ++i) text.append("\t").append(std::to_string(i));
  text += '\n';
  for (int i = 0; i < 20'000; ++i) text += "1\t1\n";
  EXPECT_NE(trc_refusal(text).find("do not fit into memory"), std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
