// What is seen as a picture: the canvas and all that lies over it, drawn once more.
import { gradientStops } from './colours.js';

const visible = (element) => {
  const style = getComputedStyle(element);
  return style.visibility !== 'hidden' && element.getClientRects().length > 0;
};

class Drawing {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas, ratio) {
    this.room = canvas.getBoundingClientRect();
    this.sheet = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height });
    this.context = /** @type {CanvasRenderingContext2D} */ (this.sheet.getContext('2d'));
    this.context.drawImage(canvas, 0, 0);
    this.context.scale(ratio, ratio);
  }

  box(element) {
    const { left, top, width, height } = element.getBoundingClientRect();
    return { left: left - this.room.left, top: top - this.room.top, width, height };
  }

  text(element) {
    if (!visible(element)) return;
    const { left, top, width, height } = this.box(element);
    const style = getComputedStyle(element);
    const font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
    const centred = style.position === 'absolute' || style.textAnchor === 'middle';
    const textAlign = centred ? 'center' : 'left';
    const fillStyle = style.fill && element.namespaceURI.endsWith('svg') ? style.fill : style.color;
    Object.assign(this.context, { font, fillStyle, textAlign, textBaseline: 'middle' });
    this.context.fillText(element.textContent, centred ? left + width / 2 : left, top + height / 2);
  }

  colours(element, stops) {
    const { left, top, width, height } = this.box(element);
    const gradient = this.context.createLinearGradient(left, 0, left + width, 0);
    stops.forEach((colour, i) => gradient.addColorStop(i / (stops.length - 1), colour));
    this.context.fillStyle = gradient;
    this.context.fillRect(left, top, width, height);
  }

  // A bar with upright ends.
  bar(element) {
    if (!visible(element)) return;
    const { left, top, width, height } = this.box(element);
    this.context.strokeStyle = getComputedStyle(element).borderBottomColor;
    this.context.lineWidth = 2;
    this.context.beginPath();
    this.context.lineTo(left + 1, top);
    this.context.lineTo(left + 1, top + height - 1);
    this.context.lineTo(left + width - 1, top + height - 1);
    this.context.lineTo(left + width - 1, top);
    this.context.stroke();
  }

  // A line of an SVG drawing whose middle is its origin.
  line(svg, line) {
    if (!visible(svg)) return;
    const { left, top, width, height } = this.box(svg);
    const scale = width / svg.viewBox.baseVal.width;
    this.context.strokeStyle = getComputedStyle(line).color;
    this.context.lineWidth = 2.5;
    this.context.beginPath();
    this.context.moveTo(left + width / 2, top + height / 2);
    const [x, y] = [scale * line.x2.baseVal.value, scale * line.y2.baseVal.value];
    this.context.lineTo(left + width / 2 + x, top + height / 2 + y);
    this.context.stroke();
  }
}

/**
 * The canvas must hold what was just drawn.  main: the element of canvas and overlay; ratio: pixels of the canvas
 * per pixel of the layout; lift: see gradientStops.  Returns a canvas.
 * @param {Element} main
 * @param {HTMLCanvasElement} canvas
 * @param {number} ratio
 * @param {number} lift
 * @returns {HTMLCanvasElement}
 */
export function pictureOf(main, canvas, ratio, lift) {
  const drawing = new Drawing(canvas, ratio);
  const all = (selector) => Array.from(main.querySelectorAll(selector));
  all('.tick-numbers span, .pane-name, #scale .length, #legend .heading, #legend .note, #legend .numbers span').forEach(
    (element) => drawing.text(element),
  );
  all('#scale .bar').forEach((element) => drawing.bar(element));
  all('#legend .colours').forEach((element) => drawing.colours(element, gradientStops(lift)));
  const cross = /** @type {Element} */ (main.querySelector('#cross'));
  for (const line of cross.querySelectorAll('line')) drawing.line(cross, line);
  for (const letter of cross.querySelectorAll('text')) {
    if (getComputedStyle(letter).opacity !== '0') drawing.text(letter);
  }
  return drawing.sheet;
}

/**
 * Hands it to the user as a PNG file.
 * @param {HTMLCanvasElement} picture
 * @param {string} name
 */
export function savePicture(picture, name) {
  picture.toBlob((blob) => {
    if (!blob) return; // too large for this browser
    const link = Object.assign(document.createElement('a'), {
      href: URL.createObjectURL(blob),
      download: `${name.replace(/[\\/:*?"<>|]/g, '_')}.png`,
    });
    link.click();
    URL.revokeObjectURL(link.href);
  });
}
