// Numbers for people.
const kSuperscripts = '⁰¹²³⁴⁵⁶⁷⁸⁹';

/**
 * To the nearest whole number, with separators.
 * @param {number} value
 * @returns {string}
 */
export const whole = (value) => Math.round(value).toLocaleString('en-US');

/**
 * To so many digits; very large and small numbers with a power of ten.
 * @param {number} value
 * @param {number} [digits]
 * @returns {string}
 */
export function rounded(value, digits = 4) {
  const size = Math.abs(value);
  if (value === 0 || (size >= 1e-4 && size < 1e7)) {
    return size >= 1e3
      ? whole(Number(value.toPrecision(digits + 1)))
      : String(Number(value.toPrecision(digits)));
  }
  const [mantissa, exponent] = value.toExponential(digits - 1).split('e');
  const power = String(Math.abs(Number(exponent))).replace(/\d/g, (d) => kSuperscripts[d]);
  return `${Number(mantissa)} × 10${Number(exponent) < 0 ? '⁻' : ''}${power}`;
}

/**
 * A coordinate in full, as short as it is; a true minus sign.
 * @param {number} value
 * @returns {string}
 */
export function coordinate(value) {
  const size = Math.abs(value);
  const text =
    value === 0 || (size >= 1e-4 && size < 1e7)
      ? size.toLocaleString('en-US', { maximumSignificantDigits: 12 })
      : rounded(size, 12);
  return value < 0 ? `−${text}` : text;
}

/**
 * 1, 2 or 5 times a power of ten, at most `limit`.
 * @param {number} limit
 * @returns {number}
 */
export function roundLength(limit) {
  const power = 10 ** Math.floor(Math.log10(limit));
  return Number(((limit >= 5 * power ? 5 : limit >= 2 * power ? 2 : 1) * power).toPrecision(12));
}
