#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace affskel::core {

/// The start tag of an element; valid while it is handled.
struct XmlElement {
  std::string_view name;
  const char** attributes;  ///< name, value, name, value, ..., null
  std::uint64_t line;       ///< where the tag begins, counted from 1
  std::size_t end;          ///< behind the tag, in bytes

  /// Value of an attribute with its references replaced, empty when there is none.
  std::string attribute(std::string_view which) const;
};

/// How elements and attributes are called.
enum class XmlNames {
  kAsWritten,  ///< with their prefixes
  kOfSpaces,   ///< "NAMESPACE|name", or "name" in none
};

/// Takes the contents of an XML text in their order; comments and processing instructions are left out.
class XmlHandler {
 public:
  enum class Next { kReadOn, kStop };

  virtual ~XmlHandler() = default;
  /// With XmlNames::kOfSpaces, before the element that declares it: a prefix, empty for none, and what it stands for.
  virtual void declare(std::string_view /*prefix*/, std::string_view /*space*/) {}
  /// After kStop, here and below, nothing behind the tag is looked at: it need not be XML.
  virtual Next open(const XmlElement& element) = 0;
  /// The end of an element, also of an empty one, with the line of its tag.
  virtual Next close(std::string_view /*name*/, std::uint64_t /*line*/) { return Next::kReadOn; }
  /// A piece of text, also of a CDATA section; references are replaced.
  /// `stays`: it lies in the bytes that are read; otherwise it is gone after the call.
  virtual void text(std::string_view /*text*/, bool /*stays*/) {}
};

/// How the reading of an XML text ended.
enum class XmlEnd {
  kStopped,    ///< the handler stopped it
  kComplete,   ///< the root element was closed
  kCutOff,     ///< inside the root element
  kNoElement,  ///< there is none
};

/// Reads an XML text by libexpat.  Memory is bounded whatever the bytes: a tag or comment has at most 1 MiB,
/// elements are nested at most 100 deep and have with their attributes and namespaces' prefixes at most 1000 different
/// names, those of namespaces at most 1024 bytes.  Document types are refused, so that there are no entities but the
/// predefined ones.
/// @throws CoreError kBadInput with the line for what is not well-formed or beyond these bounds, and what the
/// handler throws.
XmlEnd read_xml(std::string_view bytes, XmlHandler& handler, XmlNames names = XmlNames::kAsWritten);

}  // namespace affskel::core
