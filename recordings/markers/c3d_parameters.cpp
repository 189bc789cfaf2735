// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/c3d_parameters.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>

#include "recordings/markers/c3d_words.h"

namespace marey::recordings {
namespace {

constexpr std::size_t kBlock = 512;

/// Returns the bytes of one value. The file uses the same numbers as types; -1 is text.
std::size_t value_size(int type) {
  return type == -1 ? 1 : static_cast<std::size_t>(type);
}

std::size_t value_count(const std::vector<std::uint8_t>& dimensions) {
  std::size_t count = 1;
  for (const std::uint8_t dimension : dimensions) {
    count *= dimension;
    // Far more than any file holds, and no overflow with 255 dimensions.
    if (count > (std::size_t{1} << 40U)) return count;
  }
  return count;
}

/// Reads records one after the other; `at_` never passes `end_`.
class SectionReader {
 public:
  SectionReader(std::string_view bytes,
                std::size_t begin,
                std::size_t end,
                C3dProcessor processor,
                std::vector<std::string>& notes)
      : bytes_(bytes), at_(begin), end_(end), processor_(processor), notes_(notes) {}

  std::vector<C3dGroup> read() {
    while (record()) {
    }
    // Parameters may come before their group.
    for (auto& [group_id, parameter] : parameters_) {
      const std::uint8_t id = group_id;
      auto group = std::find_if(
          groups_.begin(), groups_.end(), [&](const C3dGroup& g) { return g.id == id; });
      if (group == groups_.end()) {
        groups_.push_back({"GROUP" + std::to_string(id), "", false, id, {}});
        group = groups_.end() - 1;
      }
      group->parameters.push_back(std::move(parameter));
    }
    return std::move(groups_);
  }

 private:
  void note(std::size_t byte, const std::string& what) {
    notes_.push_back("byte " + std::to_string(byte) + ": " + what);
  }

  [[nodiscard]] bool has(std::size_t count) const { return count <= end_ - at_; }
  int signed_byte() {
    const char byte = bytes_[at_++];
    return static_cast<signed char>(byte);
  }
  std::size_t unsigned_byte() { return static_cast<unsigned char>(bytes_[at_++]); }

  /// Reads one group or parameter; returns false after the last one, or at a defect.
  bool record() {
    const std::size_t begin = at_;
    if (!has(2)) return false;
    const int name_length = signed_byte();
    const int id = signed_byte();
    // The section ends with zeros; some vendors write half a record there.
    if (name_length == 0 || id == 0) return false;
    const auto length = static_cast<std::size_t>(std::abs(name_length));
    if (!has(length + 2)) {
      note(begin, "a parameter's name reaches into the data; the parameters end here");
      return false;
    }
    std::string name(bytes_.substr(at_, length));
    at_ += length;
    const std::size_t next_from = at_;
    const std::size_t offset = c3d_word(processor_, bytes_.data() + at_);
    at_ += 2;
    const bool locked = name_length < 0;
    const bool read = id < 0 ? group(std::move(name), locked, -id)
                             : parameter(std::move(name), locked, id);
    if (!read) note(begin, "the parameter here makes no sense and is left out");
    if (offset == 0) return false;
    if (offset < 2 || offset > end_ - next_from) {
      note(next_from, "the next parameter would be in the data; the parameters end here");
      return false;
    }
    at_ = next_from + offset;
    return true;
  }

  /// Reads the description of the current record; empty if it is incomplete.
  std::string description() {
    if (!has(1)) return {};
    const std::size_t length = unsigned_byte();
    if (!has(length)) return {};
    std::string text(bytes_.substr(at_, length));
    at_ += length;
    return text;
  }

  bool group(std::string name, bool locked, int id) {
    if (id > 127) return false;
    const auto number = static_cast<std::uint8_t>(id);
    for (const C3dGroup& other : groups_) {
      if (other.id == number) return false;
    }
    std::string text = description();
    groups_.push_back({std::move(name), std::move(text), locked, number, {}});
    return true;
  }

  bool parameter(std::string name, bool locked, int group) {
    if (!has(2)) return false;
    const int type = signed_byte();
    const std::size_t rank = unsigned_byte();
    if ((type != -1 && type != 1 && type != 2 && type != 4) || !has(rank)) return false;
    C3dParameter p;
    p.name = std::move(name);
    p.locked = locked;
    for (std::size_t i = 0; i < rank; ++i) {
      p.dimensions.push_back(static_cast<std::uint8_t>(unsigned_byte()));
    }
    const std::size_t count = value_count(p.dimensions);
    const std::size_t size = value_size(type);
    if (count > (end_ - at_) / size) return false;
    read_values(p, type, count);
    at_ += count * size;
    p.description = description();
    parameters_.emplace_back(static_cast<std::uint8_t>(group), std::move(p));
    return true;
  }

  void read_values(C3dParameter& p, int type, std::size_t count) {
    const char* from = bytes_.data() + at_;
    if (type == -1) {
      p.values = C3dText{std::string(from, count)};
    } else if (type == 1) {
      C3dBytes values(count);
      std::transform(from, from + count, values.begin(), [](char c) {
        return static_cast<std::int8_t>(c);
      });
      p.values = std::move(values);
    } else if (type == 2) {
      C3dIntegers values(count);
      for (std::size_t i = 0; i < count; ++i) {
        values[i] = static_cast<std::int16_t>(c3d_word(processor_, from + 2 * i));
      }
      p.values = std::move(values);
    } else {
      C3dReals values(count);
      for (std::size_t i = 0; i < count; ++i) {
        values[i] = c3d_real(processor_, from + 4 * i);
      }
      p.values = std::move(values);
    }
  }

  std::string_view bytes_;
  std::size_t at_;
  std::size_t end_;
  C3dProcessor processor_;
  std::vector<std::string>& notes_;
  std::vector<C3dGroup> groups_;
  std::vector<std::pair<std::uint8_t, C3dParameter>> parameters_;
};

Error too_long(const std::string& what) {
  return bad_input("C3D", what + " is longer than the format has room for", "shorten it");
}

/// Returns type, dimensions and values: the part between a record's head and its
/// description.
std::string value_bytes(const C3dParameter& p, C3dProcessor processor) {
  std::string out;
  const auto head = [&](int type) {
    out += static_cast<char>(type);
    out += static_cast<char>(p.dimensions.size());
    for (const std::uint8_t d : p.dimensions) out += static_cast<char>(d);
  };
  if (const auto* text = std::get_if<C3dText>(&p.values)) {
    head(-1);
    out += text->characters;
  } else if (const auto* bytes = std::get_if<C3dBytes>(&p.values)) {
    head(1);
    for (const std::int8_t value : *bytes) out += static_cast<char>(value);
  } else if (const auto* integers = std::get_if<C3dIntegers>(&p.values)) {
    head(2);
    for (const std::int16_t value : *integers) {
      append_c3d_word(out, processor, static_cast<std::uint16_t>(value));
    }
  } else if (const auto* reals = std::get_if<C3dReals>(&p.values)) {
    head(4);
    for (const float value : *reals) append_c3d_real(out, processor, value);
  }
  return out;
}

bool append_record(std::string& out,
                   C3dProcessor processor,
                   const std::string& name,
                   bool locked,
                   int id,
                   const std::string& values,
                   const std::string& description) {
  const std::size_t offset = 2 + values.size() + 1 + description.size();
  if (name.empty() || name.size() > 127 || description.size() > 255 || offset > 65535) {
    return false;
  }
  const auto length = static_cast<int>(name.size());
  out += static_cast<char>(locked ? -length : length);
  out += static_cast<char>(id);
  out += name;
  append_c3d_word(out, processor, static_cast<std::uint16_t>(offset));
  out += values;
  out += static_cast<char>(description.size());
  out += description;
  return true;
}

}  // namespace

std::vector<C3dGroup> parse_c3d_parameters(std::string_view bytes,
                                           std::size_t begin,
                                           std::size_t end,
                                           C3dProcessor processor,
                                           std::vector<std::string>& notes) {
  MAREY_ASSERT(begin <= end && end <= bytes.size());
  return SectionReader(bytes, begin, end, processor, notes).read();
}

Result<std::string> c3d_parameter_section(const std::vector<C3dGroup>& groups,
                                          C3dProcessor processor) {
  std::string out(4, '\0');
  for (const C3dGroup& group : groups) {
    if (!append_record(
            out, processor, group.name, group.locked, -group.id, "", group.description)) {
      return too_long("group " + group.name);
    }
    for (const C3dParameter& p : group.parameters) {
      if (!append_record(out,
                         processor,
                         p.name,
                         p.locked,
                         group.id,
                         value_bytes(p, processor),
                         p.description)) {
        return too_long("parameter " + group.name + ":" + p.name);
      }
    }
  }
  // At least one zero ends the section.
  const std::size_t blocks = (out.size() + 2 + kBlock - 1) / kBlock;
  out.resize(blocks * kBlock, '\0');
  out[0] = 1;
  out[1] = 0x50;
  // Readers take the data's position from POINT:DATA_START; this byte may be too small.
  out[2] = static_cast<char>(std::min<std::size_t>(blocks, 255));
  out[3] = static_cast<char>(processor);
  return out;
}

}  // namespace marey::recordings
