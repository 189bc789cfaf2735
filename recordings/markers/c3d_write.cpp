// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "recordings/markers/c3d.h"
#include "recordings/markers/c3d_layout.h"
#include "recordings/markers/c3d_parameters.h"
#include "recordings/markers/c3d_words.h"

namespace marey::recordings {
namespace {

constexpr std::int64_t kMaxInWord = 65535;
constexpr int kMaxHeaderEvents = 18;

std::uint16_t clipped(std::int64_t value) {
  return static_cast<std::uint16_t>(std::clamp<std::int64_t>(value, 0, kMaxInWord));
}

void put_integers(std::vector<C3dGroup>& groups,
                  const char* group,
                  const char* name,
                  std::initializer_list<std::int64_t> values) {
  C3dParameter p;
  p.name = name;
  C3dIntegers words;
  for (const std::int64_t value : values) {
    words.push_back(static_cast<std::int16_t>(static_cast<std::uint16_t>(value)));
  }
  if (words.size() > 1) p.dimensions = {static_cast<std::uint8_t>(words.size())};
  p.values = std::move(words);
  put_parameter(groups, group, std::move(p));
}

void put_real(std::vector<C3dGroup>& groups,
              const char* group,
              const char* name,
              double value) {
  C3dParameter p;
  p.name = name;
  p.values = C3dReals{static_cast<float>(value)};
  put_parameter(groups, group, std::move(p));
}

double signed_scale(const C3dInfo& info) {
  return info.numbers == C3dNumbers::kReal ? -info.scale : info.scale;
}

/// Returns the parameters with the values of this file's header.
std::vector<C3dGroup> settled_groups(const C3dInfo& info) {
  std::vector<C3dGroup> groups = info.groups;
  const std::int64_t last = info.first_frame + info.frames - 1;
  put_integers(groups, "POINT", "USED", {info.points});
  put_integers(groups, "POINT", "FRAMES", {clipped(info.frames)});
  put_real(groups, "POINT", "SCALE", signed_scale(info));
  put_real(groups, "POINT", "RATE", info.rate_hz);
  put_integers(groups, "POINT", "DATA_START", {0});
  put_integers(groups, "ANALOG", "USED", {info.analog_channels});
  if (info.analog_channels > 0) {
    put_real(groups, "ANALOG", "RATE", info.rate_hz * info.analog_per_frame);
  }
  const bool is_long = info.frames > kMaxInWord;
  if (is_long || find_parameter(groups, "POINT", "LONG_FRAMES") != nullptr) {
    put_real(groups, "POINT", "LONG_FRAMES", static_cast<double>(info.frames));
  }
  if (last > kMaxInWord || info.first_frame > kMaxInWord ||
      find_parameter(groups, "TRIAL", "ACTUAL_END_FIELD") != nullptr) {
    const auto low = [](std::int64_t n) { return n % 65536; };
    const auto high = [](std::int64_t n) { return n / 65536; };
    const std::int64_t first = info.first_frame;
    put_integers(groups, "TRIAL", "ACTUAL_START_FIELD", {low(first), high(first)});
    put_integers(groups, "TRIAL", "ACTUAL_END_FIELD", {low(last), high(last)});
  }
  return groups;
}

void set_word(std::string& header,
              C3dProcessor processor,
              std::size_t number,
              int value) {
  std::string bytes;
  append_c3d_word(bytes, processor, static_cast<std::uint16_t>(value));
  header.replace(2 * (number - 1), bytes.size(), bytes);
}

void set_real(std::string& header,
              C3dProcessor processor,
              std::size_t number,
              double value) {
  std::string bytes;
  append_c3d_real(bytes, processor, static_cast<float>(value));
  header.replace(2 * (number - 1), bytes.size(), bytes);
}

std::string header_of(const C3dInfo& info, int data_block) {
  const C3dProcessor p = info.processor;
  std::string header(kC3dBlock, '\0');
  header[0] = 2;
  header[1] = 0x50;
  const std::int64_t last = info.first_frame + info.frames - 1;
  set_word(header, p, 2, info.points);
  set_word(header, p, 3, info.analog_channels * info.analog_per_frame);
  set_word(header, p, 4, clipped(info.first_frame));
  set_word(header, p, 5, clipped(last));
  set_word(header, p, 6, info.interpolation_gap);
  set_real(header, p, 7, signed_scale(info));
  set_word(header, p, 9, data_block);
  set_word(header, p, 10, info.analog_channels > 0 ? info.analog_per_frame : 0);
  set_real(header, p, 11, info.rate_hz);
  set_word(header, p, 150, 12345);
  const auto count = std::min<std::size_t>(info.header_events.size(), kMaxHeaderEvents);
  set_word(header, p, 151, static_cast<int>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const C3dHeaderEvent& event = info.header_events[i];
    set_real(header, p, 153 + 2 * i, event.time_s);
    header[376 + i] = event.shown ? 1 : 0;
    std::string label = event.label.substr(0, 4);
    label.resize(4, ' ');
    header.replace(396 + 4 * i, 4, label);
  }
  return header;
}

std::uint16_t integer_word(float value) {
  if (std::isnan(value)) return 0;
  // Up to 65535 for unsigned samples, which have the same bits.
  const double kept = std::clamp<double>(std::round(value), -32768.0, 65535.0);
  return static_cast<std::uint16_t>(static_cast<std::int32_t>(kept));
}

}  // namespace

Result<std::string> c3d_head(const C3dInfo& info) {
  MAREY_ASSERT(info.points >= 0 && info.analog_channels >= 0);
  MAREY_ASSERT(info.analog_per_frame >= 1 && info.frames >= 0 && info.first_frame >= 0);
  MAREY_ASSERT(info.rate_hz > 0.0 && info.scale > 0.0);
  if (info.points > kMaxInWord ||
      std::int64_t{info.analog_channels} * info.analog_per_frame > kMaxInWord) {
    return bad_input("C3D",
                     "a frame has room for 65535 points and as many analog samples",
                     "write fewer of them");
  }
  std::vector<C3dGroup> groups = settled_groups(info);
  // Writes the section twice: first to determine its length, then with the data's
  // position.
  Result<std::string> section = c3d_parameter_section(groups, info.processor);
  if (!section) return section;
  const std::size_t data_block = 2 + section->size() / kC3dBlock;
  if (data_block > static_cast<std::size_t>(kMaxInWord)) {
    return bad_input(
        "C3D", "the parameters are longer than 32 MB", "write fewer of them");
  }
  put_integers(groups, "POINT", "DATA_START", {static_cast<std::int64_t>(data_block)});
  section = c3d_parameter_section(groups, info.processor);
  if (!section) return section;
  return header_of(info, static_cast<int>(data_block)) + *section;
}

Result<C3dWriter> C3dWriter::create(const std::filesystem::path& path,
                                    const C3dInfo& info) {
  const Result<std::string> head = c3d_head(info);
  if (!head) {
    Error error = head.error();
    error.where = path.string();
    return error;
  }
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  file->append(*head);
  return C3dWriter(*std::move(file), info);
}

C3dWriter::C3dWriter(AtomicFile file, const C3dInfo& info)
    : file_(std::move(file)),
      processor_(info.processor),
      numbers_(info.numbers),
      words_per_frame_(
          4 * static_cast<std::size_t>(info.points) +
          static_cast<std::size_t>(info.analog_channels * info.analog_per_frame)),
      frames_left_(info.frames) {}

void C3dWriter::append(const C3dFrame& frame) {
  MAREY_ASSERT(frames_left_ > 0);
  MAREY_ASSERT(frame.points.size() + frame.analog.size() == words_per_frame_);
  --frames_left_;
  bytes_.clear();
  for (const std::vector<float>* words : {&frame.points, &frame.analog}) {
    for (const float word : *words) {
      if (numbers_ == C3dNumbers::kReal) {
        append_c3d_real(bytes_, processor_, word);
      } else {
        append_c3d_word(bytes_, processor_, integer_word(word));
      }
    }
  }
  file_.append(bytes_);
}

Status C3dWriter::commit() {
  MAREY_ASSERT(frames_left_ == 0);
  return file_.commit();
}

}  // namespace marey::recordings
