#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "core/files/base64.h"

namespace affskel::tests {

/// What a VTK reader finds in an XML file with inline data, by the format's description and not by the
/// writers.
class VtkXmlFile {
 public:
  struct Array {
    std::string section, tag, type, bytes;
    int components = 1;

    template <typename Number>
    std::vector<Number> numbers() const {
      std::vector<Number> values(bytes.size() / sizeof(Number));
      std::memcpy(values.data(), bytes.data(), bytes.size());
      return values;
    }
  };
  struct Piece {
    std::string tag;
    std::map<std::string, Array> arrays;  // by name
  };

  explicit VtkXmlFile(const std::string& file) : text(file) {
    compressed_ = file.find("compressor=\"vtkZLibDataCompressor\"") != std::string::npos;
    std::string section;
    for (std::size_t at = file.find('<'); at != std::string::npos; at = file.find('<', at + 1)) {
      const std::size_t end = file.find('>', at);
      const std::string tag = file.substr(at, end - at + 1);
      const std::string name = tag.substr(1, tag.find_first_of(" >") - 1);
      if (name == "Piece") pieces.push_back({tag, {}});
      if (name != "DataArray" && name != "Array") {
        if (name.front() != '/') section = name;
        continue;
      }
      EXPECT_EQ(attribute(tag, "format"), "binary");
      const std::string components = attribute(tag, "NumberOfComponents");
      const Array array{section, tag, attribute(tag, "type"),
                        decoded(file.substr(end + 1, file.find('<', end) - end - 1)),
                        components.empty() ? 1 : std::stoi(components)};
      const std::string key = attribute(tag, "Name");
      if (section == "FieldData") {
        facts[key] = array;
      } else {
        EXPECT_TRUE(pieces.back().arrays.emplace(key, array).second) << key;
      }
    }
  }

  static std::string attribute(const std::string& tag, const std::string& name) {
    const std::size_t at = tag.find(" " + name + "=\"");
    if (at == std::string::npos) return "";
    const std::size_t begin = at + name.size() + 3;
    return tag.substr(begin, tag.find('"', begin) - begin);
  }

  std::string tag(const std::string& name) const {
    const std::size_t at = text.find("<" + name + " ");
    return at == std::string::npos ? "" : text.substr(at, text.find('>', at) - at + 1);
  }

  /// The string of a field array.
  std::string fact(const std::string& key) const {
    const auto found = facts.find(key);
    if (found == facts.end() || found->second.type != "String") return "";
    return found->second.bytes.substr(0, found->second.bytes.find('\0'));
  }

  std::string text;
  std::vector<Piece> pieces;
  std::map<std::string, Array> facts;

 private:
  static std::uint64_t number(const std::string& bytes, std::size_t index) {
    std::uint64_t value = 0;
    EXPECT_LE(8 * (index + 1), bytes.size());
    std::memcpy(&value, bytes.data() + 8 * index, sizeof value);
    return value;
  }

  std::string decoded(const std::string& digits) const {
    if (compressed_) return inflated(digits);
    const auto all = core::bytes_of_base64(digits);
    EXPECT_TRUE(all.has_value());
    EXPECT_EQ(number(*all, 0), all->size() - 8);
    return all->substr(8);
  }

  // Two texts in base64: the head, whose length its first number tells, and the blocks.
  static std::string inflated(std::string digits) {
    std::erase_if(digits, [](char c) { return c == '\n' || c == ' '; });
    const auto first = core::bytes_of_base64(digits.substr(0, 12));
    EXPECT_TRUE(first.has_value());
    const std::size_t blocks = number(*first, 0), head_bytes = 8 * (3 + blocks),
                      head_digits = (head_bytes + 2) / 3 * 4;
    const auto head = core::bytes_of_base64(digits.substr(0, head_digits));
    const auto body = core::bytes_of_base64(digits.substr(head_digits));
    EXPECT_TRUE(head.has_value() && body.has_value());
    EXPECT_EQ(head->size(), head_bytes);
    std::string all;
    std::size_t at = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const bool last = b + 1 == blocks && number(*head, 2) != 0;
      std::string block(number(*head, last ? 2 : 1), '\0');
      uLongf size = block.size();
      EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(block.data()), &size,
                           reinterpret_cast<const Bytef*>(body->data() + at), number(*head, 3 + b)),
                Z_OK);
      EXPECT_EQ(size, block.size());
      all += block;
      at += number(*head, 3 + b);
    }
    EXPECT_EQ(at, body->size());
    return all;
  }

  bool compressed_ = false;
};

}  // namespace affskel::tests
