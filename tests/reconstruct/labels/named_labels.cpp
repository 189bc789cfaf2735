// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/reconstruct/labels/named_labels.h"

#include <sstream>

#include <gtest/gtest.h>

namespace marey::reconstruct::testing {

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> list;
  for (std::string word; in >> word;) list.push_back(word);
  return list;
}

std::string name_of(const std::vector<std::string>& labels,
                    const MarkerNames& names,
                    const std::string& label) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] != label) continue;
    return names.landmarks[i] ? std::string(names.landmarks[i]->name) : "";
  }
  return "no such label";
}

std::vector<std::string> unnamed(const std::vector<std::string>& labels) {
  const MarkerNames names = name_markers(labels);
  std::vector<std::string> list;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (names.landmarks[i] == nullptr) list.push_back(labels[i]);
  }
  return list;
}

void expect_names(const std::vector<std::string>& labels,
                  const std::string& set,
                  std::initializer_list<LabelAndName> pairs) {
  const MarkerNames names = name_markers(labels);
  EXPECT_EQ(names.set, set);
  ASSERT_EQ(names.landmarks.size(), labels.size());
  for (const LabelAndName& pair : pairs) {
    EXPECT_EQ(name_of(labels, names, pair.label), pair.name) << pair.label;
  }
}

}  // namespace marey::reconstruct::testing
