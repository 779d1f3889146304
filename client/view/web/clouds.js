// Sample points as balls (the skeleton) and as a smooth skin (the eroded solid), stretched like the cells of
// the lattice.  The points have a fixed order, and a slider only moves the end of what is drawn.
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  LessDepth,
  LessEqualDepth,
  Points,
  ShaderMaterial,
} from 'three';
import { CellShape, kOnEllipsoid } from './cell.js';

const kBallVertex = `
  attribute vec4 colour;
  uniform float size;
  varying vec3 vColour;
  void main() {
    vColour = colour.rgb;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    gl_PointSize = size;
  }`;

const kBallFragment = `
  uniform float lift;
  varying vec3 vColour;
  ${kOnEllipsoid}
  void main() {
    if (outside()) discard;
    float lit = max(0.0, dot(normalOfEllipsoid(), vec3(-0.42, 0.55, 0.72)));
    float shade = mix(1.0, 0.55 + 0.45 * lit, smoothstep(2.0, 6.0, size));
    gl_FragColor = vec4((vColour + lift * (1.0 - vColour)) * shade, 1.0);
  }`;

// A point whose neighbours are all shown is hidden by them and not drawn.  Points of equal depth would be
// blended twice, so every point is moved by a pseudo-random fraction of the cell's size.
const kSkinVertex = `
  attribute vec3 inward;
  attribute float around;
  uniform float size, step, level;
  varying vec3 vNormal;
  void main() {
    vNormal = normalMatrix * -inward;
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    at.z += 0.2 * step * fract(sin(dot(position, vec3(127.1, 311.7, 74.7))) * 43758.5);
    gl_Position = around >= level ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * at;
    gl_PointSize = size;
  }`;

const kSkinFragment = `
  uniform vec3 tint;
  uniform float opacity;
  varying vec3 vNormal;
  ${kOnEllipsoid}
  void main() {
    if (outside()) discard;
    float lit = dot(normalize(vNormal), vec3(-0.42, 0.55, 0.72));
    gl_FragColor = vec4(tint * (0.62 + 0.38 * lit), opacity);
  }`;

function cloud(geometry, material, order) {
  const points = new Points(geometry, material);
  points.frustumCulled = false; // what is drawn is a part of the geometry
  points.renderOrder = order;
  return points;
}

export class BallCloud {
  // cell: the steps of the lattice, page units.
  constructor(positions, colours, cell) {
    this.shape = new CellShape(cell, 0.55);
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', new BufferAttribute(positions, 3));
    this.geometry.setAttribute('colour', new BufferAttribute(colours, 4, true));
    this.uniforms = { ...this.shape.uniforms, lift: { value: 0 } };
    this.object = cloud(
      this.geometry,
      new ShaderMaterial({
        vertexShader: kBallVertex,
        fragmentShader: kBallFragment,
        uniforms: this.uniforms,
      }),
      0,
    );
  }

  showFirst(count) {
    this.geometry.setDrawRange(0, count);
  }

  // pixels: of the drawing buffer, per page unit.
  look(camera, pixels) {
    this.shape.look(camera, pixels);
  }

  paint(theme) {
    this.uniforms.lift.value = theme.lift;
  }
}

export class SkinCloud {
  // inward: unit normals as bytes, 3 per point; order: indices into the positions; cell: the three edges of a
  // point's cell, page units; around: per point the least share of v0 among its neighbours.
  constructor(positions, { inward, order, cell, around }) {
    this.shape = new CellShape(cell, 0.85); // neighbours overlap in every direction
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', new BufferAttribute(positions, 3));
    this.geometry.setAttribute('inward', new BufferAttribute(inward, 3, true));
    this.geometry.setAttribute('around', new BufferAttribute(around, 1));
    this.geometry.setIndex(new BufferAttribute(order, 1));
    this.uniforms = {
      ...this.shape.uniforms,
      step: { value: this.shape.edge },
      level: { value: 0 },
      opacity: { value: 0.6 },
      tint: { value: [1, 1, 1] },
    };
    // First only the depth, then the colour of what is nearest: one translucent layer without sorting.
    this.object = new Group();
    for (const colour of [false, true]) {
      this.object.add(
        cloud(
          this.geometry,
          new ShaderMaterial({
            vertexShader: kSkinVertex,
            fragmentShader: kSkinFragment,
            uniforms: this.uniforms,
            transparent: true,
            colorWrite: colour,
            depthWrite: !colour,
            depthFunc: colour ? LessEqualDepth : LessDepth,
          }),
          colour ? 2 : 1,
        ),
      );
    }
  }

  // The first `count` points of the order: those of at least `level`, a share of v0.
  show(count, level) {
    this.geometry.setDrawRange(0, count);
    this.uniforms.level.value = level;
  }

  paint(theme) {
    this.uniforms.tint.value = theme.skin;
  }

  look(camera, pixels) {
    this.shape.look(camera, pixels);
  }
}
