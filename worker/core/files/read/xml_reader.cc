#include "core/files/read/xml_reader.h"

#include <expat.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <set>
#include <utility>

#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

constexpr std::size_t kMaxTag = std::size_t{1} << 20;  // bytes
constexpr std::size_t kPiece = kMaxTag / 4;            // what libexpat is given at once; it copies it
constexpr std::size_t kMaxDepth = 100;
// libexpat keeps every name that it has met.
constexpr std::size_t kMaxNames = 1000;
constexpr std::size_t kMaxSpace = 1024;  // bytes of a namespace's name, which stands in every name
constexpr char kBehindSpace = '|';

class Reader {
 public:
  Reader(std::string_view bytes, XmlHandler& handler, XmlNames names)
      : bytes_(bytes),
        handler_(handler),
        parser_(names == XmlNames::kOfSpaces ? XML_ParserCreateNS(nullptr, kBehindSpace)
                                             : XML_ParserCreate(nullptr),
                XML_ParserFree) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_open, on_close);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), on_doctype);
    XML_SetStartNamespaceDeclHandler(parser_.get(), on_space);
  }

  XmlEnd run() {
    for (std::size_t at = 0;;) {
      const std::size_t size = std::min(kPiece, bytes_.size() - at);
      const bool last = at + size == bytes_.size();
      const XML_Status status =
          XML_Parse(parser_.get(), bytes_.data() + at, static_cast<int>(size), last ? XML_TRUE : XML_FALSE);
      if (error_) std::rethrow_exception(error_);
      if (stopped_) return XmlEnd::kStopped;
      if (status == XML_STATUS_ERROR) return failed();
      if (last) return XmlEnd::kComplete;
      at += size;
      if (at - std::min(at, byte_index()) > kMaxTag) {
        fail_at(line(), "a tag or comment of XML is longer than " + std::to_string(kMaxTag) + " bytes");
      }
    }
  }

 private:
  std::uint64_t line() const { return XML_GetCurrentLineNumber(parser_.get()); }
  std::size_t byte_index() const {
    return static_cast<std::size_t>(std::max<XML_Index>(0, XML_GetCurrentByteIndex(parser_.get())));
  }
  std::size_t byte_count() const { return static_cast<std::size_t>(XML_GetCurrentByteCount(parser_.get())); }

  // Exceptions must not pass through libexpat, which is C.
  template <typename Action>
  static void guarded(void* reader, Action&& action) {
    Reader& self = *static_cast<Reader*>(reader);
    if (self.stopped_ || self.error_) return;  // the end of an empty element comes after its stop
    try {
      self.stopped_ = action(self) == XmlHandler::Next::kStop;
    } catch (...) {
      self.error_ = std::current_exception();
    }
    if (self.stopped_ || self.error_) XML_StopParser(self.parser_.get(), XML_FALSE);
  }

  static void on_open(void* reader, const char* name, const char** attributes) {
    guarded(reader, [&](Reader& self) { return self.open(name, attributes); });
  }

  static void on_close(void* reader, const char* name) {
    guarded(reader, [&](Reader& self) {
      --self.depth_;
      return self.handler_.close(name, self.line());
    });
  }

  static void on_text(void* reader, const char* text, int size) {
    guarded(reader, [&](Reader& self) {
      self.text({text, static_cast<std::size_t>(size)});
      return XmlHandler::Next::kReadOn;
    });
  }

  static void on_doctype(void* reader, const char*, const char*, const char*, int) {
    guarded(reader, [](Reader& self) -> XmlHandler::Next {
      fail_at(self.line(), "a document type (<!DOCTYPE) and its entities are not read");
    });
  }

  static void on_space(void* reader, const char* prefix, const char* space) {
    guarded(reader, [&](Reader& self) {
      self.declare(prefix == nullptr ? "" : prefix, space == nullptr ? "" : space);
      return XmlHandler::Next::kReadOn;
    });
  }

  void declare(const std::string& prefix, std::string_view space) {
    if (space.size() > kMaxSpace)
      fail_at(line(), "a namespace of XML has a name of more than " + std::to_string(kMaxSpace) + " bytes");
    count_name("xmlns:" + prefix);
    handler_.declare(prefix, space);
  }

  void count_name(std::string name) {
    names_.insert(std::move(name));
    if (names_.size() > kMaxNames) {
      fail_at(line(), "elements and attributes of XML have more than " + std::to_string(kMaxNames) +
                          " different names");
    }
  }

  XmlHandler::Next open(const char* name, const char** attributes) {
    if (++depth_ > kMaxDepth) {
      fail_at(line(), "elements of XML are nested more than " + std::to_string(kMaxDepth) + " deep");
    }
    has_element_ = true;
    count_name(name);
    for (const char** a = attributes; *a != nullptr; a += 2) count_name(*a);
    return handler_.open({name, attributes, line(), byte_index() + byte_count()});
  }

  void text(std::string_view text) {
    const std::string_view raw = bytes_.substr(byte_index(), byte_count());
    // What ends a line may be two bytes, which libexpat tells as one.
    const bool same = raw == text || (text == "\n" && (raw == "\r\n" || raw == "\r"));
    handler_.text(same ? raw : text, same);
  }

  XmlEnd failed() {
    switch (const XML_Error code = XML_GetErrorCode(parser_.get())) {
      case XML_ERROR_NO_MEMORY:
        throw std::bad_alloc();
      case XML_ERROR_NO_ELEMENTS:
        return has_element_ ? XmlEnd::kCutOff : XmlEnd::kNoElement;
      case XML_ERROR_SYNTAX:
        return XmlEnd::kNoElement;  // there is text in front of the first element
      case XML_ERROR_UNCLOSED_TOKEN:
      case XML_ERROR_UNCLOSED_CDATA_SECTION:
        fail_at(line(), "a tag, a comment or a section of XML does not end");
      case XML_ERROR_INVALID_TOKEN:
        fail_at(line(),
                "not well-formed XML: a character that must not stand here, or an attribute that is not "
                "NAME=\"VALUE\"");
      default:
        fail_at(line(), std::string("not well-formed XML: ") + XML_ErrorString(code));
    }
  }

  std::string_view bytes_;
  XmlHandler& handler_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::set<std::string> names_;
  std::size_t depth_ = 0;
  bool has_element_ = false;
  bool stopped_ = false;
  std::exception_ptr error_;
};

}  // namespace

std::string XmlElement::attribute(std::string_view which) const {
  for (const char** a = attributes; *a != nullptr; a += 2) {
    if (which == a[0]) return a[1];
  }
  return "";
}

XmlEnd read_xml(std::string_view bytes, XmlHandler& handler, XmlNames names) {
  return Reader(bytes, handler, names).run();
}

}  // namespace affskel::core
