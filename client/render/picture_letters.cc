#include "client/render/picture_letters.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "base/utf8.h"

namespace affskel::client {
namespace {

constexpr char32_t kFirstLatin = 0xC0;
// Latin-1 and Latin Extended-A: a letter and its mark, '_' none; 16 of them a row.
constexpr std::string_view kLatin =
    "A`A'A^A~A:Ao  C,E`E'E^E:I`I'I^I:"
    "D/N~O`O'O^O~O:  O/U`U'U^U:Y'    "
    "a`a'a^a~a:ao  c,e`e'e^e:i`i'i^i:"
    "d/n~o`o'o^o~o:  o/u`u'u^u:y'  y:"
    "A-a-AuauA,a,C'c'C^c^C.c.CvcvDvdv"
    "D/d/E-e-EueuE.e.E,e,EvevG^g^Gugu"
    "G.g.G,g,H^h^H/h/I~i~I-i-IuiuI,i,"
    "I.i_    J^j^K,k,k_L'l'L,l,LvlvL."
    "l.L/l/N'n'N,n,Nvnvn'N,n,O-o-Ouou"
    "O\"o\"    R'r'R,r,RvrvS's'S^s^S,s,"
    "SvsvT,t,TvtvT/t/U~u~U-u-UuuuUouo"
    "U\"u\"U,u,W^w^Y^y^Y:Z'z'Z.z.Zvzvs_";

// What is written in the place of a character.
constexpr std::pair<char32_t, std::string_view> kOthers[] = {
    {0xA0, " "},    {0xAD, "-"},     {0xB4, "'"},   {0xB5, "u"},   {0xB7, "."},    {0xC6, "AE"},
    {0xD7, "x"},    {0xDE, "Th"},    {0xDF, "ss"},  {0xE6, "ae"},  {0xF7, ":"},    {0xFE, "th"},
    {0x132, "IJ"},  {0x133, "ij"},   {0x152, "OE"}, {0x153, "oe"}, {0x1E9E, "SS"}, {0x2010, "-"},
    {0x2011, "-"},  {0x2013, "-"},   {0x2014, "-"}, {0x2018, "'"}, {0x2019, "'"},  {0x201C, "\""},
    {0x201D, "\""}, {0x2026, "..."}, {0x2212, "-"},
};

// The characters that put a mark on the letter before them.
constexpr std::pair<char32_t, char> kMarks[] = {
    {0x300, '`'}, {0x301, '\''}, {0x302, '^'}, {0x303, '~'}, {0x304, '-'},
    {0x306, 'u'}, {0x307, '.'},  {0x308, ':'}, {0x30A, 'o'}, {0x30B, '"'},
    {0x30C, 'v'}, {0x326, ','},  {0x327, ','}, {0x328, ','}, {0x338, '/'},
};
constexpr char32_t kFirstMark = 0x300, kLastMark = 0x36F;
// With a comma below, in Romanian.
constexpr char32_t kFirstComma = 0x218;
constexpr std::string_view kCommas = "SsTt";

template <typename Value, std::size_t N>
const Value* value_of(const std::pair<char32_t, Value> (&table)[N], char32_t character) {
  for (const auto& [key, value] : table)
    if (key == character) return &value;
  return nullptr;
}

// The character that begins there, and where the next does.  @param text well-formed.
char32_t next_character(std::string_view text, std::size_t& at) {
  const auto lead = static_cast<std::uint8_t>(text[at++]);
  if (lead < 0x80) return lead;
  const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : 1;
  char32_t character = lead & (0x3FU >> more);
  for (int i = 0; i < more; ++i) character = character << 6 | (static_cast<std::uint8_t>(text[at++]) & 0x3FU);
  return character;
}

void append(char32_t character, std::vector<PictureLetter>& letters) {
  if (character < 0x80) {
    letters.push_back({static_cast<char>(character)});
  } else if (const std::string_view* others = value_of(kOthers, character)) {
    for (const char c : *others) letters.push_back({c});
  } else if (character >= kFirstLatin && character < kFirstLatin + kLatin.size() / 2) {
    const std::size_t place = 2 * (character - kFirstLatin);
    letters.push_back({kLatin[place], kLatin[place + 1]});
  } else if (character >= kFirstComma && character < kFirstComma + kCommas.size()) {
    letters.push_back({kCommas[character - kFirstComma], ','});
  } else if (character >= kFirstMark && character <= kLastMark && !letters.empty()) {
    if (const char* mark = value_of(kMarks, character)) letters.back().mark = *mark;
  } else {
    letters.push_back({});
  }
}

}  // namespace

std::vector<PictureLetter> picture_letters(std::string_view text) {
  const std::string known = base::to_utf8(text);
  std::vector<PictureLetter> letters;
  for (std::size_t at = 0; at < known.size();) append(next_character(known, at), letters);
  return letters;
}

}  // namespace affskel::client
