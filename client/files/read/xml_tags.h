#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace affskel::client {

/// The tags of an XML text, one after the other; comments, declarations and processing instructions are
/// passed over.  Nothing behind the tag in hand is looked at, so what follows it need not be text.  The bytes
/// must outlive the tags.
class XmlTags {
 public:
  explicit XmlTags(std::string_view bytes) : bytes_(bytes) {}

  /// Moves on to the next tag; false at the end of the text.
  /// @throws CoreError kBadInput with the line for a tag that does not end or is malformed.
  bool next();

  std::string_view name() const { return name_; }
  bool opens() const { return opens_; }    ///< <a> or <a/>
  bool closes() const { return closes_; }  ///< </a> or <a/>
  /// Value of an attribute, empty when there is none.
  std::string attribute(std::string_view name) const;

  /// What stands between the tag before and this one, in the parts that comments and the like leave.
  const std::vector<std::string_view>& text_before() const { return text_before_; }

  std::size_t end() const { return end_; }      ///< behind the tag, in bytes
  std::uint64_t line() const { return line_; }  ///< where it begins, counted from 1

 private:
  void move_to(std::size_t place);
  // Where the tag in hand ends; a > in quotation marks does not end it.
  std::size_t closing_bracket() const;
  void read_attributes(std::string_view text);

  std::string_view bytes_, name_;
  std::vector<std::string_view> text_before_;
  std::size_t begin_ = 0, end_ = 0;
  std::uint64_t line_ = 1;
  bool opens_ = false, closes_ = false;
  std::vector<std::pair<std::string_view, std::string_view>> attributes_;
};

}  // namespace affskel::client
