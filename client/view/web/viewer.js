// Models, camera and controls together.
import { Color } from 'three';
import { Body } from './body.js';
import { Clip } from './clip.js';
import { Clipping } from './clipping.js';
import { themeColours } from './colours.js';
import { Link, readLink, writeLink } from './link.js';
import { Model } from './model.js';
import { rounded, whole } from './numbers.js';
import { drawCross, drawScaleBar, paintLegend } from './overlay.js';
import { sectionFor, showFacts, showWarnings } from './panel.js';
import { pictureOf, savePicture } from './picture.js';
import { Probe, valuesOf } from './probe.js';
import { Slider, Stops } from './slider.js';
import { Stage } from './stage.js';
import { TickNumbers } from './ticks.js';

const kBottomInset = 22; // pixels below the box: a tick and a line of numbers
const kSideInset = 16; // pixels beside the box, and the widest number: a tick and gaps
const kUsualOpacity = 20; // per cent
const kLow = 350; // pixels: the height of a phone on its side, less the heading
const kLayers = ['mesh', 'skeleton', 'eroded', 'marks', 'axes', 'scale'];

/** @type {(id: string) => any} */
const element = (id) => document.getElementById(id);
const box = (selector) => /** @type {Element} */ (document.querySelector(selector)).getBoundingClientRect();

/** The page once its data are read. */
export class Viewer {
  constructor(page) {
    this.page = page;
    this.clip = new Clip();
    this.models = page.models.map((facts) => new Model(facts, page, this.clip));
    this.makePanes();
    const half = [0, 1, 2].map((c) => Math.max(...page.models.map(({ halfBox }) => halfBox[c])));
    this.stage = new Stage(element('canvas'), {
      stance: page.stance,
      halfBox: half,
      panes: this.models.length,
      inset: () => this.freeEdges(),
      room: () => ({ above: box('nav').bottom - box('main').top, below: box('main').bottom - box('.foot').top }),
      beforeDraw: () => this.beforeDraw(),
      changed: () => this.link && this.link.update(),
      thin: (every) => this.models.forEach(({ skeleton }) => skeleton.drawn.thin(every)),
    });
    this.models.forEach((model, i) => this.stage.scenes[i].add(...Object.values(model.layers)));
    this.wireSliders();
    this.wireLook();
    this.clipping = new Clipping(this.clip, {
      half: (axis) => this.stage.halfBox.getComponent(axis),
      toward: (axis) => this.stage.toward(axis),
      skeletons: () => this.models.map(({ skeleton }) => skeleton.places),
      coordinate: (axis, at) => this.models[0].coordinates([at, at, at])[axis],
      changed: () => this.stage.changeScene(),
    });
    this.body = new Body(page, this.models, (opacity) =>
      opacity === null ? this.stage.changeScene() : this.setOpacity(opacity),
    );
    this.showPanel();
    this.wireButtons();
    this.setTheme(window.matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark');
    this.probe = new Probe(element('probe'), element('canvas'), (x, y) => this.found(x, y));
    this.reset();
    this.link = new Link(() => writeLink(this.seen()), (text) => this.open(text));
    this.open(window.location.hash);
  }

  // Of each model an element over the canvas, for the numbers of its box and, of two, its name.
  makePanes() {
    const panes = element('panes');
    this.panes = this.models.map((model, i) => {
      const pane = Object.assign(document.createElement('div'), { className: 'pane' });
      const numbers = Object.assign(document.createElement('div'), { className: 'tick-numbers' });
      pane.append(numbers);
      if (this.models.length > 1) {
        // The operator first: names may be too long to be shown whole.
        const textContent = `${'AB'[i]}: ${model.facts.operator}, ${model.facts.name}`;
        pane.append(Object.assign(document.createElement('p'), { className: 'pane-name', textContent }));
      }
      panes.append(pane);
      return pane;
    });
    this.numbers = this.models.map((model, i) => new TickNumbers(this.panes[i].firstChild, model.box));
  }

  // Whether two panes lie upon each other.
  areUpon() {
    const main = box('main');
    return this.models.length > 1 && main.width < main.height;
  }

  // Pixels that the view keeps free: for the buttons above, the legend below, the numbers round the box.  On a
  // phone on its side, buttons and legend stand beside a body that has the whole height.
  freeEdges() {
    const [main, nav, foot] = [box('main'), box('nav'), box('.foot')];
    const upon = this.areUpon();
    const name = this.models.length > 1 ? 20 : 0;
    const widest = Math.max(...this.numbers.map((numbers) => numbers.widest())) + kSideInset;
    const width = upon ? main.width : main.width / this.models.length;
    if (main.height < kLow) {
      const roomy = main.width > 2 * kLow && this.models.length === 1;
      const beside = roomy ? Math.max(nav.right - main.left, box('#legend').width) : nav.right - main.left;
      return {
        top: name,
        bottom: kBottomInset + (roomy ? 0 : main.bottom - foot.top),
        side: roomy ? beside + widest : Math.min(beside + widest, width / 4),
      };
    }
    return {
      top: upon ? name : nav.bottom - main.top + name,
      bottom: kBottomInset + (upon ? 0 : main.bottom - foot.top),
      side: Math.min(widest, width / 4),
    };
  }

  beforeDraw() {
    const { stage } = this;
    const pixels = stage.pixelsPerUnit();
    const buffer = pixels * stage.renderer.getPixelRatio();
    stage.camera.updateMatrixWorld();
    element('panes').classList.toggle('upon', this.areUpon());
    stage.panes().forEach(({ left, top, width, height }, i) => {
      Object.assign(this.panes[i].style, {
        left: `${left}px`,
        top: `${top}px`,
        width: `${width}px`,
        height: `${height}px`,
      });
      this.models[i].skeleton.drawn.look(stage.camera, buffer);
      this.models[i].box.look(stage.camera);
      this.numbers[i].place(stage.camera, pixels);
    });
    drawCross(element('cross'), stage.camera);
    drawScaleBar(element('scale'), pixels / this.page.unit, stage.panes()[0].width);
    this.hideOldValues();
  }

  // Values stay while the same is seen, also when it is drawn again.
  hideOldValues() {
    const { camera, changes } = this.stage;
    const seen = JSON.stringify([camera.position.toArray(), camera.zoom, changes]);
    if (this.probe && seen !== this.seenLast) this.probe.hide();
    this.seenLast = seen;
  }

  // What a mesh without a job has none of is hidden by style.css.
  showMeshOnly() {
    document.documentElement.dataset.kind = 'mesh';
    element('marks-name').textContent = 'Defects';
    element('show-skeleton').parentElement.hidden = true;
  }

  showPanel() {
    const { page } = this;
    if (page.meshOnly) this.showMeshOnly();
    element('show-marks').parentElement.hidden = page.models.every(({ arrays }) => arrays.markPositions.length === 0);
    showWarnings(element('warnings'), page.models);
    showFacts(element('facts-list'), page.models);
    element('ticks').textContent =
      `Numbers on the box are coordinates, its ticks ${rounded(this.models[0].box.tickDistance, 6)} units apart.`;
    const few = page.models.find(({ lowestThreshold, threshold }) => lowestThreshold > threshold / 10);
    element('limited').hidden = !few;
    if (few) {
      element('limited').textContent =
        `This page holds the ${whole(few.pointsHere)} sample points with |H| above ` +
        `${rounded(few.lowestThreshold)}, of ${whole(few.points)}.`;
    }
  }

  // One threshold for all models whose skeletons are of one operator.
  wireSliders() {
    const { page, models } = this;
    const alike = models.every(({ facts }) => facts.operator === models[0].facts.operator);
    const groups = alike ? [models] : models.map((model) => [model]);
    this.thresholds = groups
      .map((group, i) => ({ group, section: sectionFor(element('threshold'), i) }))
      .map(({ group, section }, i) => this.wireThreshold(group, section, groups.length > 1 ? ` ${'AB'[i]}` : ''));
    element('level').hidden = page.levels.length === 0;
    element('show-eroded').parentElement.hidden = page.levels.length === 0;
    if (page.levels.length === 0) return;
    this.level = new Stops(element('level'), {
      values: page.levels.map((share) => 100 * share),
      changed: () => {
        this.toggle('eroded', true);
        this.applyLevel();
      },
    });
  }

  wireThreshold(group, section, suffix) {
    const [{ skeleton }] = group;
    section.querySelector('.name').textContent = skeleton.name + suffix;
    section.querySelector('.symbol').textContent = skeleton.symbol;
    section.querySelector('input[inputmode]').setAttribute('aria-label', skeleton.name + suffix);
    const slider = new Slider(section, {
      low: Math.max(...group.map((model) => model.skeleton.low)),
      high: Math.max(...group.map((model) => model.skeleton.high)),
      curve: skeleton.curve,
      changed: () => this.applyThreshold(threshold),
    });
    const threshold = { group, slider, count: section.querySelector('output') };
    for (const part of section.querySelectorAll('label, input')) part.hidden = !group.some((model) => model.skeleton.choice);
    return threshold;
  }

  applyThreshold({ group, slider, count }) {
    const lines = group.map((model) => {
      model.shown = model.skeleton.show(slider.value);
      return model.skeleton.describe(model.shown, slider.value);
    });
    count.textContent = group.length > 1 ? lines.map((line, i) => `${'AB'[i]}: ${line}`).join('; ') : lines[0];
    this.stage.changeScene();
  }

  applyLevel() {
    if (!this.level) return;
    const { place } = this.level;
    const lines = this.models.map((model) => {
      model.showLevel(place);
      const { volume, triangles } = model.facts.eroded[place];
      return `${rounded((100 * volume) / model.facts.volume, 3)} % of the volume, ${whole(triangles)} triangles`;
    });
    element('level-count').textContent =
      lines.length > 1 ? lines.map((line, i) => `${'AB'[i]}: ${line}`).join('; ') : lines[0];
    this.stage.changeScene();
  }

  wireLook() {
    element('opacity').addEventListener('input', () => this.setOpacity(element('opacity').valueAsNumber));
    for (const name of kLayers) {
      const check = element(`show-${name}`);
      check.addEventListener('change', () => this.toggle(name, check.checked));
    }
  }

  setOpacity(value) {
    element('opacity').value = value;
    element('opacity-value').textContent = `${element('opacity').valueAsNumber} %`;
    for (const model of this.models) model.fade(element('opacity').valueAsNumber);
    this.stage.changeScene();
  }

  toggle(name, on) {
    element(`show-${name}`).checked = on;
    for (const model of this.models) {
      if (model.layers[name]) model.layers[name].visible = on;
    }
    if (name === 'axes') {
      element('cross').classList.toggle('off', !on);
      element('panes').classList.toggle('off', !on);
    }
    if (name === 'scale') element('scale').classList.toggle('off', !on);
    this.setOpacity(element('opacity').valueAsNumber);
  }

  wireButtons() {
    for (const view of ['front', 'side', 'top']) {
      element(`view-${view}`).addEventListener('click', () => this.stage.show(view));
    }
    element('reset').addEventListener('click', () => this.reset());
    element('theme').addEventListener('click', () => this.setTheme(this.theme === 'dark' ? 'light' : 'dark'));
    element('save').addEventListener('click', () => this.save());
    element('full').hidden = !document.fullscreenEnabled;
    element('full').addEventListener('click', () =>
      document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen(),
    );
    element('fold').addEventListener('click', () => {
      const open = document.body.classList.toggle('open');
      element('fold').setAttribute('aria-expanded', open);
    });
    document.addEventListener('keydown', (event) => this.pressKey(event));
  }

  pressKey(event) {
    const view = { 1: 'front', 2: 'side', 3: 'top' }[event.key];
    if (event.target.matches('input, select') || event.ctrlKey || event.metaKey || event.altKey) return;
    if (view) this.stage.show(view);
    if (event.key === '0') this.reset();
    // What shows this page over another closes it then; here nothing is told but the key.
    if (event.key === 'Escape' && window.parent !== window) window.parent.postMessage('affskel-escape', '*');
  }

  reset() {
    for (const { slider, group } of this.thresholds) slider.set(Math.max(...group.map((m) => m.skeleton.first)));
    if (this.level) this.level.put(this.page.firstLevel);
    this.clipping.set({ axis: '', beyond: '<', at: 0 });
    element('opacity').value = kUsualOpacity;
    this.body.show('');
    for (const name of kLayers) this.toggle(name, name !== 'eroded' || this.page.showLevel);
    this.applySliders();
    this.stage.show('start');
  }

  applySliders() {
    for (const threshold of this.thresholds) this.applyThreshold(threshold);
    this.applyLevel();
  }

  // What a link keeps.
  seen() {
    return {
      ...this.stage.looking(),
      thresholds: this.thresholds.map(({ slider }) => slider.value),
      level: this.level ? this.level.values[this.level.place] : 0,
      shown: kLayers.filter((name) => element(`show-${name}`).checked),
      opacity: element('opacity').valueAsNumber,
      body: this.body.chosen,
      clip: this.clipping.text(),
    };
  }

  /**
   * Shows what a link keeps.
   * @param {string} text
   */
  open(text) {
    const seen = readLink(text);
    const thresholds = seen.thresholds || [];
    thresholds.slice(0, this.thresholds.length).forEach((value, i) => this.thresholds[i].slider.set(value));
    if (this.level && 'level' in seen) this.level.put(this.level.nearest(seen.level));
    this.applySliders();
    const { shown } = seen;
    if (shown) kLayers.forEach((name) => this.toggle(name, shown.includes(name)));
    this.body.show(seen.body || '');
    if ('opacity' in seen) this.setOpacity(seen.opacity);
    if (seen.clip) this.clipping.set(seen.clip);
    if (seen.view) this.stage.show(seen.view);
    else if ('azimuth' in seen) this.stage.look(seen.azimuth, seen.elevation, seen.target, seen.zoom);
  }

  setTheme(name) {
    this.theme = name;
    document.documentElement.dataset.theme = name;
    const colours = themeColours(name);
    this.stage.renderer.setClearColor(new Color(colours.background));
    for (const model of this.models) model.paint(colours);
    paintLegend(element('legend'), colours.lift);
    element('theme').textContent = name === 'dark' ? 'Light background' : 'Dark background';
    this.stage.requestDraw();
  }

  // x, y: pixels of the canvas.
  found(x, y) {
    const at = this.stage.rayAt(x, y);
    const found = at && this.models[at.number].at(at.ray);
    return found && { model: this.models[at.number], found };
  }

  valuesAt(x, y) {
    const result = this.found(x, y);
    return result && { what: result.found.what, ...Object.fromEntries(valuesOf(result.model, result.found)) };
  }

  // What is seen, as a canvas.
  picture() {
    this.stage.draw();
    const { renderer, canvas } = this.stage;
    const main = /** @type {Element} */ (document.querySelector('main'));
    return pictureOf(main, canvas, renderer.getPixelRatio(), themeColours(this.theme).lift);
  }

  save() {
    savePicture(this.picture(), this.page.models.map(({ name }) => name).join(' and '));
  }

  // For tests.
  state() {
    const { camera, controls } = this.stage;
    const [model] = this.models;
    return {
      operator: model.facts.operator,
      threshold: this.thresholds[0].slider.value,
      thresholds: this.thresholds.map(({ slider }) => slider.value),
      level: this.level ? this.page.levels[this.level.place] : 0,
      levels: this.page.levels,
      skeletonShown: model.shown,
      shown: this.models.map((each) => each.shown),
      erodedShown: this.models.map((each) => (this.level ? each.facts.eroded[this.level.place].triangles : 0)),
      pointsHere: model.facts.pointsHere,
      marked: model.facts.arrays.markPositions.length / 6, // edges
      looking: this.stage.looking(),
      opacity: model.opacity,
      body: this.body.chosen,
      resolution: this.stage.resolution,
      every: this.stage.every,
      panes: this.stage.panes(),
      camera: { position: camera.position.toArray(), target: controls.target.toArray(), zoom: camera.zoom },
      visible: Object.fromEntries(Object.entries(model.layers).map(([name, layer]) => [name, layer.visible])),
      theme: this.theme,
    };
  }

  // Mean milliseconds to draw the scene, over `frames` drawings, each waited for.
  frameTime(frames) {
    let sum = 0;
    for (let f = 0; f < frames; ++f) {
      this.stage.orbit(0.05, 0);
      sum += this.stage.measure();
    }
    return sum / frames;
  }
}
