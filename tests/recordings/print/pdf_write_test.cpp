// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/pdf_write.h"

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

PrintedDocument document() {
  PrintedPage page{0.210, 0.297, {}, {}, {}};
  page.shapes.emplace_back(PrintedBoxes{{{0.1, 0.1, 0.2, 0.2}}, Ink::kBlack});
  page.shapes.emplace_back(PrintedText{"90° and 80 mm", {0.1, 0.25}});
  return {"A document", {page, page}};
}

// A clock would cause differences: PDFs have dates to the second.
TEST(PdfWrite, GivesTheSameBytesAgain) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_pdf(folder / "a.pdf", document()));
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  ASSERT_TRUE(write_pdf(folder / "b.pdf", document()));
  const auto a = read_file(folder / "a.pdf");
  const auto b = read_file(folder / "b.pdf");
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->substr(0, 5), "%PDF-");
  EXPECT_TRUE(*a == *b);
}

TEST(PdfWrite, LeavesNothingWhereItCannotWrite) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "file", "in the way"));
  const Status written = write_pdf(folder / "file" / "a.pdf", document());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::kBadInput);
  EXPECT_EQ(*read_file(folder / "file"), "in the way");
  const auto entries = std::filesystem::directory_iterator(folder.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

}  // namespace
}  // namespace marey::recordings
