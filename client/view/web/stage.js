// The camera and the loop that draws: orthographic, so that lengths on the screen are lengths of the body.
import { Box3, OrthographicCamera, Quaternion, Scene, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'orbit-controls';

const kDistance = 12; // of the camera: further away than any panning moves the body
const kDepth = 6; // how far before and behind the middle things are drawn
const kMargin = 1.06;
const kMaxPixelRatio = 2; // more costs time and cannot be seen
const kOrbitStep = Math.PI / 18;

// Where the camera stands, seen from the body, and what is up: z up and facing -y, or y up and facing +z.
const kViews = {
  z: { front: [0, -1, 0], side: [1, 0, 0], top: [0, -1e-5, 1], start: [0.5, -1, 0.25] },
  y: { front: [0, 0, 1], side: [1, 0, 0], top: [0, 1, 1e-5], start: [0.5, 0.25, 1] },
};

export class Stage {
  // `halfBox`: half the sides of the body's box about the origin.  `inset()`: pixels to keep free at the top,
  // at the bottom and on either side when the whole body is shown.  `beforeDraw` runs before every drawing.
  constructor(canvas, { up, halfBox, inset, beforeDraw }) {
    this.canvas = canvas;
    this.inset = inset;
    this.views = kViews[up];
    this.halfBox = new Vector3(...halfBox);
    this.beforeDraw = beforeDraw;
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.scene = new Scene();
    this.camera = new OrthographicCamera(-1, 1, 1, -1, kDistance - kDepth, kDistance + kDepth);
    this.camera.up.set(0, up === 'y' ? 1 : 0, up === 'z' ? 1 : 0);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false; // see pressKey
    this.controls.screenSpacePanning = true;
    this.controls.minZoom = 0.1;
    this.controls.maxZoom = 500;
    this.controls.addEventListener('change', () => this.requestDraw());
    this.controls.addEventListener('start', () => (this.view = ''));
    canvas.addEventListener('wheel', () => (this.view = ''));
    canvas.addEventListener('keydown', (event) => this.pressKey(event));
    // A new size clears the canvas: draw at once, before it is seen black.
    new ResizeObserver(() => {
      if (this.resize()) this.draw();
    }).observe(canvas.parentElement);
    this.resize();
    this.show('start');
  }

  // One of front, side, top, start: the whole body in the window.
  show(view) {
    this.view = view;
    this.controls.target.set(0, 0, 0);
    this.camera.position.set(...this.views[view]).setLength(kDistance);
    this.controls.update();
    this.camera.updateMatrixWorld();
    const box = new Box3(this.halfBox.clone().negate(), this.halfBox.clone());
    box.applyMatrix4(this.camera.matrixWorldInverse);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const { top, bottom, side } = this.inset();
    const room = Math.max(height / 3, height - top - bottom);
    this.camera.zoom = Math.min(((width - 2 * side) / height) / box.max.x, room / height / box.max.y) / kMargin;
    this.camera.setViewOffset(width, height, 0, (bottom - top) / 2, width, height); // updates the projection
    this.requestDraw();
  }

  // Fits the canvas to its parent element; false when that has no size.
  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) return false;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, kMaxPixelRatio));
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.right = clientWidth / clientHeight;
    this.camera.left = -this.camera.right;
    if (this.camera.view)
      this.camera.setViewOffset(
        clientWidth,
        clientHeight,
        0,
        this.camera.view.offsetY,
        clientWidth,
        clientHeight,
      );
    if (this.view)
      this.show(this.view); // still as chosen: keep it in the window
    else this.requestDraw();
    return true;
  }

  // Screen pixels (of the layout) per page unit.
  pixelsPerUnit() {
    return (this.canvas.clientHeight / 2) * this.camera.zoom;
  }

  requestDraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }

  draw() {
    this.beforeDraw();
    this.renderer.render(this.scene, this.camera);
  }

  pressKey(event) {
    const orbit = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const zoom = { '+': 1.2, '=': 1.2, '-': 1 / 1.2 }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || (!orbit && !zoom)) return;
    event.preventDefault();
    this.view = '';
    if (orbit) this.orbit(orbit[0] * kOrbitStep, orbit[1] * kOrbitStep);
    if (zoom) this.zoom(zoom);
  }

  // Turns the camera about the body; `elevation` keeps away from the poles, where "right" is undefined.
  orbit(azimuth, elevation) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyQuaternion(new Quaternion().setFromAxisAngle(this.camera.up, azimuth));
    const now = Math.PI / 2 - offset.angleTo(this.camera.up);
    const limit = Math.PI / 2 - 1e-5;
    const turn = Math.min(limit, Math.max(-limit, now + elevation)) - now;
    const axis = new Vector3().crossVectors(offset, this.camera.up).normalize();
    offset.applyQuaternion(new Quaternion().setFromAxisAngle(axis, turn));
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  zoom(factor) {
    this.camera.zoom = Math.min(
      this.controls.maxZoom,
      Math.max(this.controls.minZoom, this.camera.zoom * factor),
    );
    this.camera.updateProjectionMatrix();
    this.requestDraw();
  }
}
