// A slider with its value in a field beside it: the slider gives round values, the field takes any.
import { typed } from './typed.js';

const kSteps = 1000;

/** Any value of a range. */
export class Slider {
  // root: holds a range and a field for numbers.  low, high: what both are kept to.  curve: place on the slider
  // (0 .. 1) = (share of the range) ^ (1 / curve).  changed(value): after every change by the user.
  constructor(root, { low, high, curve = 1, changed }) {
    this.range = root.querySelector('input[type=range]');
    this.field = root.querySelector('input[inputmode]');
    this.low = low;
    this.high = high;
    this.curve = curve;
    this.range.max = kSteps;
    this.range.addEventListener('input', () => {
      this.put(this.round(low + (high - low) * (this.range.valueAsNumber / kSteps) ** curve));
      changed(this.value);
    });
    this.field.addEventListener('change', () => {
      const value = typed(this.field.value);
      this.set(Number.isFinite(value) ? value : this.value);
      changed(this.value);
    });
  }

  // Rounds down to three digits, but not below the low end.  Rounding up could lose the last points.
  round(value) {
    if (value <= this.low) return this.low;
    const unit = 10 ** (Math.floor(Math.log10(value)) - 2);
    return Math.max(this.low, Number((Math.floor(value / unit + 1e-9) * unit).toPrecision(3)));
  }

  put(value) {
    this.value = value;
    this.field.value = String(Number(value.toPrecision(5)));
    this.range.setAttribute('aria-valuetext', this.field.value);
  }

  set(value) {
    this.put(Math.min(Math.max(value, this.low), Math.max(this.high, this.low)));
    const share = this.high > this.low ? (this.value - this.low) / (this.high - this.low) : 0;
    this.range.value = Math.round(kSteps * share ** (1 / this.curve));
  }
}

/** A slider that stands at given values only; what is typed into its field goes to the nearest of them. */
export class Stops {
  // root: as for Slider.  values: ascending, at least one.  changed(place): after every change by the user.
  constructor(root, { values, changed }) {
    this.range = root.querySelector('input[type=range]');
    this.field = root.querySelector('input[inputmode]');
    this.values = values;
    this.range.max = values.length - 1;
    this.range.addEventListener('input', () => {
      this.put(this.range.valueAsNumber);
      changed(this.place);
    });
    this.field.addEventListener('change', () => {
      const value = typed(this.field.value);
      this.put(Number.isFinite(value) ? this.nearest(value) : this.place);
      changed(this.place);
    });
  }

  nearest(value) {
    const away = this.values.map((v) => Math.abs(v - value));
    return away.indexOf(Math.min(...away));
  }

  put(place) {
    this.place = place;
    this.range.value = place;
    this.field.value = String(Number(this.values[place].toPrecision(5)));
    this.range.setAttribute('aria-valuetext', this.field.value);
  }
}
