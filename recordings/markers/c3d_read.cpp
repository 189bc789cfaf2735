// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <istream>
#include <sstream>
#include <utility>

#include "core/base/input_file.h"
#include "recordings/base/other_kind.h"
#include "recordings/markers/c3d.h"
#include "recordings/markers/c3d_layout.h"
#include "recordings/markers/c3d_parameters.h"
#include "recordings/markers/c3d_words.h"

namespace marey::recordings {
namespace {

/// The header's 16-bit block number of the frames limits the length of the parameters.
constexpr std::size_t kMaxHeadBytes = std::size_t{65536} * kC3dBlock;

/// Returns the end of the records: the frames, or the section's own length.
std::size_t section_end(std::string_view head, const C3dSection& section) {
  const std::size_t blocks = static_cast<unsigned char>(head[section.begin + 2]);
  const std::size_t data_block = c3d_word(section.processor, head.data() + 16);
  const std::size_t data_at = data_block == 0 ? 0 : (data_block - 1) * kC3dBlock;
  const std::size_t begin = section.begin + 4;
  if (data_at > begin) return std::min(data_at, head.size());
  const std::size_t end = section.begin + std::max<std::size_t>(blocks, 1) * kC3dBlock;
  return std::min(std::max(end, begin), head.size());
}

}  // namespace

struct C3dReader::State {
  std::unique_ptr<std::istream> stream;
  std::string file;
  std::uint64_t size = 0;
  C3dInfo info;
  C3dLayout layout;
  std::int64_t frames_left = 0;
  bool unsigned_analog = false;
  std::string bytes;  ///< One frame.

  Status open();
};

Status C3dReader::State::open() {
  std::string head(std::min<std::uint64_t>(size, kMaxHeadBytes), '\0');
  stream->read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream->gcount()));
  if (head.empty()) return empty_file(file);
  const auto section = find_c3d_section(head, file, info.notes);
  if (!section && other_kind(head) != kBinaryKind) {
    if (const Status ok = check_kind(head, file, kC3dKind); !ok) return ok.error();
  }
  if (!section) return section.error();
  info.processor = section->processor;
  info.groups = parse_c3d_parameters(
      head, section->begin + 4, section_end(head, *section), info.processor, info.notes);
  const auto found = lay_out_c3d(head, size, file, info);
  if (!found) return found.error();
  layout = *found;
  frames_left = layout.frame_words == 0 ? 0 : info.frames;
  if (const C3dParameter* p = find_parameter(info.groups, "ANALOG", "FORMAT")) {
    const std::vector<std::string> words = texts(*p);
    unsigned_analog = info.numbers == C3dNumbers::kInteger && !words.empty() &&
                      (words[0] == "UNSIGNED" || words[0] == "unsigned");
  }
  stream->clear();
  stream->seekg(static_cast<std::streamoff>(layout.data_at));
  return Done{};
}

C3dReader::C3dReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
C3dReader::C3dReader(C3dReader&&) noexcept = default;
C3dReader& C3dReader::operator=(C3dReader&&) noexcept = default;
C3dReader::~C3dReader() = default;

Result<C3dReader> C3dReader::open(const std::filesystem::path& path) {
  auto state = std::make_unique<State>();
  state->file = path.string();
  if (const Status ok = check_input_file(path); !ok) return ok.error();
  std::error_code problem;
  state->size = std::filesystem::file_size(path, problem);
  auto stream = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (problem || !*stream) {
    return bad_input(path.string(), "the file cannot be read", "check its permissions");
  }
  state->stream = std::move(stream);
  if (Status ok = state->open(); !ok) return ok.error();
  return C3dReader(std::move(state));
}

Result<C3dReader> C3dReader::of_bytes(std::string bytes, std::string name) {
  auto state = std::make_unique<State>();
  state->file = std::move(name);
  state->size = bytes.size();
  state->stream = std::make_unique<std::istringstream>(std::move(bytes));
  if (Status ok = state->open(); !ok) return ok.error();
  return C3dReader(std::move(state));
}

const C3dInfo& C3dReader::info() const {
  return state_->info;
}

Result<bool> C3dReader::next(C3dFrame& frame) {
  State& s = *state_;
  if (s.frames_left == 0) return false;
  const std::size_t size = s.layout.bytes_per_word;
  s.bytes.resize(s.layout.frame_words * size);
  s.stream->read(s.bytes.data(), static_cast<std::streamsize>(s.bytes.size()));
  if (static_cast<std::size_t>(s.stream->gcount()) != s.bytes.size()) {
    return Error{Errc::kDevice,
                 s.file,
                 "the file became shorter while it was read",
                 "check the disk and try again"};
  }
  --s.frames_left;
  const std::size_t point_words = 4 * static_cast<std::size_t>(s.info.points);
  frame.points.resize(point_words);
  frame.analog.resize(s.layout.frame_words - point_words);
  const char* from = s.bytes.data();
  const C3dProcessor processor = s.info.processor;
  if (s.info.numbers == C3dNumbers::kReal) {
    for (float& word : frame.points)
      word = c3d_real(processor, std::exchange(from, from + 4));
    for (float& word : frame.analog)
      word = c3d_real(processor, std::exchange(from, from + 4));
    return true;
  }
  for (float& word : frame.points) {
    word = static_cast<std::int16_t>(c3d_word(processor, std::exchange(from, from + 2)));
  }
  for (float& word : frame.analog) {
    const std::uint16_t bits = c3d_word(processor, std::exchange(from, from + 2));
    word = s.unsigned_analog ? static_cast<float>(bits)
                             : static_cast<float>(static_cast<std::int16_t>(bits));
  }
  return true;
}

}  // namespace marey::recordings
