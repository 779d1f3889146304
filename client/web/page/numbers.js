// Numbers and times for people.
export { typed } from '../../view/web/typed.js';

const whole = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });
const four = new Intl.NumberFormat('en', { maximumSignificantDigits: 4 });

/**
 * To the nearest whole number, with separators.
 * @param {number} n
 * @returns {string}
 */
export const count = (n) => whole.format(n);

/**
 * One or many of a thing.
 * @param {number} n
 * @param {string} one
 * @param {string} [many]
 * @returns {string}
 */
export const counted = (n, one, many = `${one}s`) => `${count(n)} ${n === 1 ? one : many}`;

/**
 * A length, an area or a volume, to four digits or to a whole number.
 * @param {number} value
 * @returns {string}
 */
export function measure(value) {
  const size = Math.abs(value);
  return size !== 0 && (size >= 1e9 || size < 1e-3) ? value.toExponential(3).replace('e+', 'e') : (size < 1000 ? four : whole).format(value);
}

/**
 * For a field that is edited: six digits, without separators.
 * @param {number} value
 * @returns {string}
 */
export const editable = (value) => String(Number(value.toPrecision(6)));

/**
 * A size in the largest unit of which it has one.
 * @param {number} size
 * @returns {string}
 */
export function bytes(size) {
  const units = ['bytes', 'KiB', 'MiB', 'GiB', 'TiB'];
  let n = size;
  let unit = 0;
  while (n >= 1024 && unit + 1 < units.length) {
    n /= 1024;
    ++unit;
  }
  return `${unit === 0 ? count(n) : n.toPrecision(3)} ${units[unit]}`;
}

/**
 * In the two largest units.
 * @param {number} seconds
 * @returns {string}
 */
export function duration(seconds) {
  const s = Math.max(0, Math.round(seconds));
  const two = (n) => String(n).padStart(2, '0');
  if (s < 60) return `${s} s`;
  if (s < 3600) return `${Math.floor(s / 60)} min ${two(s % 60)} s`;
  if (s < 86400) return `${Math.floor(s / 3600)} h ${two(Math.floor((s % 3600) / 60))} min`;
  return `${Math.floor(s / 86400)} d ${Math.floor((s % 86400) / 3600)} h`;
}

/**
 * How long something took, which may be less than a second.
 * @param {number} seconds
 * @returns {string}
 */
export const took = (seconds) => (seconds < 10 ? `${Number(seconds.toPrecision(2))} s` : duration(seconds));

/**
 * How long since.
 * @param {number} unixMs
 * @returns {string}
 */
export const ago = (unixMs) => `${duration((Date.now() - unixMs) / 1000)} ago`;

/**
 * Date and time; "not yet" for 0.
 * @param {number} unixMs
 * @returns {string}
 */
export const moment = (unixMs) => (unixMs > 0 ? new Date(unixMs).toLocaleString() : 'not yet');
