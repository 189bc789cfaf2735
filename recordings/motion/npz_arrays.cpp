// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/npz_arrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

namespace marey::recordings {
namespace {

/// Returns the code points of UTF-8; invalid bytes become U+FFFD.
std::u32string code_points(std::string_view text) {
  std::u32string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t more = byte < 0x80   ? 0
                             : byte < 0xc2 ? 4
                             : byte < 0xe0 ? 1
                             : byte < 0xf0 ? 2
                             : byte < 0xf5 ? 3
                                           : 4;
    char32_t point = byte & (more == 0 ? 0x7fU : 0x3fU >> more);
    bool good = more < 4 && i + more < text.size();
    for (std::size_t k = 1; good && k <= more; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      good = (next & 0xc0U) == 0x80;
      point = (point << 6U) | (next & 0x3fU);
    }
    constexpr std::array<char32_t, 4> kMinCodePoint{0, 0x80, 0x800, 0x10000};
    good = good && point >= kMinCodePoint[more] && point <= 0x10ffff &&
           (point < 0xd800 || point > 0xdfff);
    out += good ? point : U'\ufffd';
    i += good ? more + 1 : 1;
  }
  return out;
}

std::string file_of(std::string_view name) {
  return std::string(name) + ".npy";
}

}  // namespace

std::string npy_bytes(std::string_view type,
                      const NpyShape& shape,
                      std::string_view data) {
  std::string head = "{'descr': '" + std::string(type) + "', 'fortran_order': False, ";
  head += "'shape': (";
  for (const std::size_t size : shape) head += std::to_string(size) + ", ";
  head += "), }";
  if (const auto at = head.find(", ), }"); at != std::string::npos && shape.size() > 1) {
    head.erase(at, 2);  // A tuple of one element keeps its comma.
  }
  constexpr std::size_t kBefore = 10;
  head.append(63 - (kBefore + head.size()) % 64, ' ');
  head += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  append(bytes, static_cast<std::uint16_t>(head.size()));
  return bytes.append(head).append(data);
}

void NpzArrays::add(std::string_view name,
                    std::string_view type,
                    const NpyShape& shape,
                    std::string_view data) {
  zip_.add(file_of(name), npy_bytes(type, shape, data));
}

void NpzArrays::add_number(std::string_view name, double value) {
  std::string data;
  append(data, value);
  add(name, "<f8", {}, data);
}

void NpzArrays::add_integer(std::string_view name, std::int64_t value) {
  std::string data;
  append(data, value);
  add(name, "<i8", {}, data);
}

void NpzArrays::add_text(std::string_view name, const std::string& text) {
  add_texts_of_shape(name, {text}, {});
}

void NpzArrays::add_texts(std::string_view name, const std::vector<std::string>& texts) {
  add_texts_of_shape(name, texts, {texts.size()});
}

void NpzArrays::add_texts_of_shape(std::string_view name,
                                   const std::vector<std::string>& texts,
                                   const NpyShape& shape) {
  std::vector<std::u32string> wide;
  std::size_t longest = 1;
  for (const std::string& text : texts) {
    wide.push_back(code_points(text));
    longest = std::max(longest, wide.back().size());
  }
  std::string data;
  for (std::u32string& text : wide) {
    text.resize(longest, U'\0');
    for (const char32_t letter : text) append(data, static_cast<std::uint32_t>(letter));
  }
  add(name, "<U" + std::to_string(longest), shape, data);
}

Error NpzInput::fail(std::string cause) const {
  return bad_input(file_, std::move(cause), advice_);
}

Error NpzInput::fail(std::string_view array, std::string cause) const {
  Error error = fail(std::move(cause));
  error.where += ": " + std::string(array);
  return error;
}

Status NpzInput::open(std::optional<ZipReader> zip) {
  zip_ = std::move(zip);
  if (!zip_) return fail("it is not a .npz archive, or it is damaged");
  if (!zip_->contains_ending(".npy")) {
    return fail("it is not a .npz archive: it holds no array");
  }
  return Done{};
}

bool NpzInput::has(std::string_view name) const {
  return zip_->contains(file_of(name));
}

Result<std::string_view> NpzInput::bytes_of(std::string_view name) {
  const auto known = files_.find(name);
  if (known != files_.end()) return std::string_view(known->second);
  auto read = zip_->read(file_of(name));
  if (auto* bytes = std::get_if<std::string>(&read)) {
    return std::string_view(
        files_.emplace(std::string(name), std::move(*bytes)).first->second);
  }
  switch (std::get<ZipProblem>(read)) {
    case ZipProblem::kAbsent:
      return fail(name, "the array is missing");
    case ZipProblem::kCompressed:
      return bad_input(file_,
                       "its arrays are compressed",
                       "write them with numpy.savez instead of savez_compressed");
    case ZipProblem::kWrongChecksum:
      return fail(name, "its checksum is wrong");
    case ZipProblem::kDamaged:
      break;
  }
  return fail(name, "it is not an array of numpy, or it is damaged");
}

Result<NpyArray> NpzInput::array(std::string_view name,
                                 std::string_view type,
                                 const NpyShape& shape) {
  const auto bytes = bytes_of(name);
  if (!bytes) return bytes.error();
  const auto array = npy_array(*bytes);
  if (!array) return fail(name, "it is not an array of numpy, or it is damaged");
  const bool fits = type == "<U" ? array->type.starts_with(type) : array->type == type;
  if (!fits || array->shape != shape) {
    return fail(name, "the array has another type or shape than the motion needs");
  }
  return *array;
}

Result<NpyArray> NpzInput::real_array(std::string_view name, const NpyShape& shape) {
  auto found = array(name, "<f8", shape);
  if (!found) return found.error();
  const std::size_t count = found->count();
  for (std::size_t i = 0; i < count; ++i) {
    if (!(std::abs(found->at<double>(i)) <= 1e12)) {
      return fail(name, "it holds a number that is not finite, or beyond all bounds");
    }
  }
  return found;
}

Result<std::vector<double>> NpzInput::reals(std::string_view name,
                                            const NpyShape& shape) {
  const auto found = real_array(name, shape);
  if (!found) return found.error();
  std::vector<double> values(found->count());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = found->at<double>(i);
  return values;
}

void NpzInput::drop(std::string_view name) {
  const auto known = files_.find(name);
  if (known != files_.end()) files_.erase(known);
}

Result<std::vector<float>> NpzInput::floats(std::string_view name,
                                            const NpyShape& shape) {
  const auto found = array(name, "<f4", shape);
  if (!found) return found.error();
  std::vector<float> values(found->count());
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = found->at<float>(i);
    if (!(std::abs(values[i]) <= 1e12F)) {
      return fail(name, "it holds a number that is not finite, or beyond all bounds");
    }
  }
  return values;
}

Result<std::vector<std::string>> NpzInput::texts(std::string_view name,
                                                 std::size_t count) {
  const auto found = array(name, "<U", {count});
  if (!found) return found.error();
  const std::size_t letters = npy_item_bytes(found->type) / 4;
  std::vector<std::string> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < letters; ++k) {
      const auto point = found->at<std::uint32_t>(i * letters + k);
      if (point == 0) break;
      append_utf8(out[i], point);
    }
  }
  return out;
}

Result<NpyShape> NpzInput::shape(std::string_view name) {
  const auto bytes = bytes_of(name);
  if (!bytes) return bytes.error();
  const auto array = npy_array(*bytes);
  if (!array) return fail(name, "it is not an array of numpy, or it is damaged");
  return array->shape;
}

Result<std::size_t> NpzInput::length(std::string_view name) {
  const auto found = shape(name);
  if (!found) return found.error();
  if (found->size() != 1) return fail(name, "it is not a list of numpy's");
  return found->front();
}

}  // namespace marey::recordings
