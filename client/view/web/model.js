// One body of the page with its skeleton and eroded solids: the layers that are drawn, and what the pointer
// finds on them.
import { Group } from 'three';
import { viridis } from './colours.js';
import { erodedPositions, meshPositions, pointPositions } from './decode.js';
import { Glass } from './glass.js';
import { makeMarks } from './marks.js';
import { makeSkeleton, weighted } from './skeleton.js';
import { TickedBox } from './ticked_box.js';

const kOthers = [0.62, 0.64, 0.67]; // of parts that do not stand out
const kFaint = 0.45; // of the body, when an eroded solid is shown in it
const kUsual = 20; // per cent on the slider of the body's opacity: the usual glass

/** A body and what is drawn of it. */
export class Model {
  /**
   * facts: of the model; page: of all; clip: see Clip.
   * @param {ModelFacts} facts
   * @param {Page} page
   * @param {import('./clip.js').Clip} clip
   */
  constructor(facts, page, clip) {
    this.facts = facts;
    this.page = page;
    this.clip = clip;
    this.skeleton = makeSkeleton(facts, page.highestShare, clip, pointPositions(facts));
    this.glass = new Glass(meshPositions(facts), facts.arrays.meshCorners, clip, 3);
    this.marks = makeMarks(facts, clip);
    this.box = new TickedBox(facts.halfBox, facts.centre, page.unit);
    this.eroded = new Group();
    this.surfaces = []; // of the eroded solid, by level; made when they are first shown
    this.layers = {
      mesh: this.glass.object,
      skeleton: this.skeleton.drawn.object,
      eroded: this.eroded,
      marks: this.marks.object,
      axes: this.box.object,
    };
    this.level = -1;
    this.opacity = kUsual;
  }

  paint(theme) {
    this.theme = theme;
    this.glass.paint(theme.body);
    this.skeleton.drawn.paint(theme);
    this.marks.paint(theme);
    this.box.paint(theme);
    for (const surface of this.surfaces.filter(Boolean)) surface.paint(theme.eroded);
  }

  /**
   * Shows the eroded solid at a level, by its place among the page's levels.
   * @param {number} level
   */
  showLevel(level) {
    this.level = level;
    if (!this.surfaces[level]) {
      const corners = this.facts.arrays[`eroded${level}Corners`];
      const surface = new Glass(erodedPositions(this.facts, level), corners, this.clip, 1);
      surface.paint(this.theme.eroded);
      this.surfaces[level] = surface;
      this.eroded.add(surface.object);
    }
    this.surfaces.forEach((surface, l) => (surface.object.visible = l === level));
  }

  /**
   * What the body's colours tell: "part", "thickness", or nothing.  chosen: a part that stands out, from 1; 0: all
   * do.
   * @param {string} what
   * @param {number} chosen
   * @param {number} highest of thickness, of the last colour, mesh units
   */
  colourBody(what, chosen, highest) {
    const { parts, arrays } = this.facts;
    if (parts.length === 0 || what === '') return this.glass.tint(null);
    if (what === 'thickness') {
      return this.glass.tint((t) => viridis(arrays.meshThickness[t] / highest).map((c) => c / 255));
    }
    return this.glass.tint((t) => {
      const part = arrays.meshParts[t];
      return chosen === 0 || chosen === part ? parts[part - 1].colour : kOthers;
    });
  }

  /**
   * opacity: of the body, per cent.
   * @param {number} opacity
   */
  fade(opacity) {
    this.opacity = opacity;
    const faint = this.eroded.visible ? kFaint : 1;
    this.glass.fade(faint * Math.min(1, opacity / kUsual), Math.max(0, (opacity - kUsual) / (100 - kUsual)));
  }

  /**
   * What of the body a ray finds: a marked edge, else the skeleton, the eroded solid, the body's surface; an opaque
   * body hides the others.
   * @param {Ray} ray
   */
  at(ray) {
    const mark = this.layers.marks.visible && this.marks.pick(ray);
    const what = this.page.meshOnly ? 'defect' : 'repaired';
    if (mark) return { what, place: mark.place, share: 0, directions: [] };
    const body = this.layers.mesh.visible && this.glass.pick(ray);
    if (body && this.opacity >= 100) return this.onBody(body);
    const skeleton = this.layers.skeleton.visible && this.skeleton.at(ray);
    if (skeleton) return skeleton;
    const eroded = this.eroded.visible && this.surfaces[this.level].pick(ray);
    if (eroded) return this.onEroded(eroded);
    return body ? this.onBody(body) : null;
  }

  onBody({ place, triangle }) {
    const { parts, arrays } = this.facts;
    if (parts.length === 0) return { what: 'surface of the body', place, share: 0, directions: [] };
    const part = arrays.meshParts[triangle];
    return {
      what: `part ${part}, a ${parts[part - 1].kind}`,
      place,
      share: 0,
      part: parts[part - 1],
      thickness: arrays.meshThickness[triangle],
      directions: [],
    };
  }

  onEroded(hit) {
    return {
      what: 'eroded solid',
      place: hit.place,
      share: this.page.levels[this.level],
      slope: weighted(this.facts.arrays[`eroded${this.level}Slopes`], hit),
      directions: [],
    };
  }

  // From page to mesh units.
  coordinates(place) {
    return place.map((c, axis) => this.facts.centre[axis] + this.page.unit * c);
  }
}
