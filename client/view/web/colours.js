// Colours: the scale of E, and what a dark theme and a light one take.

// Samples of van der Walt and Smith's viridis at equal distances, as in the renderer of pictures.
const kViridis = [
  [68, 1, 84],
  [72, 40, 120],
  [62, 74, 137],
  [49, 104, 142],
  [38, 130, 142],
  [31, 158, 137],
  [53, 183, 121],
  [110, 206, 88],
  [181, 222, 43],
  [253, 231, 37],
];

/**
 * The colour at a place on the scale, 0 .. 1: red, green and blue, 0 .. 255.
 * @param {number} t
 * @returns {number[]}
 */
export function viridis(t) {
  const place = Math.min(1, Math.max(0, t)) * (kViridis.length - 1);
  const low = Math.min(Math.floor(place), kViridis.length - 2);
  const fraction = place - low;
  return kViridis[low].map((value, c) => value + fraction * (kViridis[low + 1][c] - value));
}

/**
 * Colours at equal distances, for CSS.  lift: how far they are mixed with white, 0 .. 1.
 * @param {number} lift
 * @returns {string[]}
 */
export const gradientStops = (lift) =>
  kViridis.map((colour) => `rgb(${colour.map((c) => Math.round(c + lift * (255 - c)))})`);

/**
 * The same as a background.
 * @param {number} lift
 * @returns {string}
 */
export const gradient = (lift) => `linear-gradient(to right, ${gradientStops(lift).join(', ')})`;

/**
 * E is a volume and varies over orders of magnitude; its cube root is a length and varies evenly.
 * @param {number} share
 * @param {number} highest
 * @returns {number}
 */
export const colourPosition = (share, highest) => (highest > 0 ? Math.cbrt(Math.max(0, share) / highest) : 0);
/**
 * The share at a place on the scale.
 * @param {number} position
 * @param {number} highest
 * @returns {number}
 */
export const shareAt = (position, highest) => position ** 3 * highest;

/**
 * One colour per value, as bytes r, g, b, 255.
 * @param {ArrayLike<number>} shares
 * @param {number} highest
 * @returns {Uint8Array}
 */
export function coloursOf(shares, highest) {
  const bytes = new Uint8Array(4 * shares.length);
  for (let i = 0; i < shares.length; ++i) {
    const colour = viridis(colourPosition(shares[i], highest));
    for (let c = 0; c < 3; ++c) bytes[4 * i + c] = Math.round(colour[c]);
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}

const kDark = {
  background: 0x14181f,
  ink: 0xe8ecf1,
  body: { dark: [0.42, 0.5, 0.62], light: [0.86, 0.91, 0.97], clear: 0.075, rim: 0.42 },
  eroded: { dark: [0.7, 0.4, 0.16], light: [1, 0.68, 0.4], clear: 0.28, rim: 0.5 },
  lift: 0.12,
};
const kLight = {
  background: 0xffffff,
  ink: 0x20252c,
  body: { dark: [0.3, 0.38, 0.5], light: [0.72, 0.79, 0.88], clear: 0.1, rim: 0.42 },
  eroded: { dark: [0.62, 0.33, 0.1], light: [0.98, 0.66, 0.36], clear: 0.28, rim: 0.5 },
  lift: 0,
};

/**
 * All colours of a theme, "dark" or "light".
 * @param {string} name
 * @returns {Theme}
 */
export const themeColours = (name) => (name === 'dark' ? kDark : kLight);
