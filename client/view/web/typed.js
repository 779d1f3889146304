// Numbers that people type, for the fields of both pages.
const kNumber = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
// 0,500 is a half, as nobody groups a 0.
const kGrouped = /^[+-]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?$/;

/**
 * A number as people type it: 1234.5, 1,234.5, 5,5 or 1e-3; NaN for what is none.
 * @param {string} text
 * @returns {number}
 */
export function typed(text) {
  const joined = text.replace(/\s/g, '');
  const plain = kGrouped.test(joined) ? joined.replaceAll(',', '') : joined.replace(/^([^.,]*),([^.,]*)$/, '$1.$2');
  return kNumber.test(plain) ? Number(plain) : NaN;
}
