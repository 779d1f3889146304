// The shapes of what the modules of the page hand to each other.

type Triple = [number, number, number];

// Of the page's JSON, see client/view/page.cc.
interface Grid {
  origin: Triple;
  axes: [Triple, Triple, Triple];
}
interface ModelFacts {
  name: string;
  job: string;
  operator: string;
  frame: string;
  threshold: number;
  lowestThreshold: number;
  triangles: number;
  points: number;
  pointsHere: number;
  directions: number;
  minimum: string;
  spacing: number;
  volume: number;
  box: Triple;
  centre: Triple;
  halfBox: Triple;
  cell: [Triple, Triple, Triple];
  warnings: string[];
  pieces: [string, string][];
  meshGrid: Grid;
  pointGrid: Grid;
  parts: Part[]; // of the body's triangles, see meshParts; or none
  thickness: { highest: number; greatest: number }; // see thickness_scale() in client/artifacts/solid_parts.h
  eroded: { volume: number; triangles: number }[];
  arrays: Record<string, any>; // typed arrays
}
interface Part {
  kind: string;
  share: number; // of the volume
  volume: number;
  length: number;
  radius: number;
  colour: Triple; // 0 .. 1
}
interface Page {
  stands: string;
  stance: { right: Triple; up: Triple; front: Triple };
  unit: number;
  highestShare: number;
  scaleTitle: string;
  scaleNote: string;
  levels: number[];
  firstLevel: number;
  showLevel: boolean;
  meshOnly: boolean; // one mesh without a job
  models: ModelFacts[];
}

interface Look {
  dark: number[];
  light: number[];
  clear: number;
  rim: number;
}
interface Theme {
  background: number;
  ink: number;
  body: Look;
  eroded: Look;
  lift: number;
}

interface Point {
  x: number;
  y: number;
  z: number;
}
interface Ray {
  origin: Point;
  along: Point;
}
interface Hit {
  depth: number;
  place: number[];
  vertices: number[];
  weights: number[];
  triangle: number;
}
// What the pointer is on.
interface Found {
  what: string;
  place: number[];
  share: number;
  slope?: number | null;
  strength?: number | null;
  part?: Part | null;
  thickness?: number | null;
  divergence?: number | null;
  directions: number[][];
}
interface ProbedModel {
  facts: ModelFacts;
  coordinates(place: number[]): number[];
}

interface Skeleton {
  drawn: any;
  places: Float32Array; // of its points, page units
  values: Float32Array;
  name: string;
  symbol: string;
  curve: number;
  low: number;
  high: number;
  first: number;
  keeps(value: number, least: number): boolean;
  choice: boolean;
  describe(shown: number, least: number): string;
  at(ray: Ray): Found | null;
  show(threshold: number): number;
}

interface Seen {
  view: string;
  azimuth: number;
  elevation: number;
  zoom: number;
  target: number[];
  thresholds: number[];
  level: number;
  shown: string[];
  opacity: number | null;
  body: string;
  clip: string;
}
// What a link says of it; without a view or a camera where it says nothing of it.
interface LinkState {
  view?: string;
  azimuth?: number;
  elevation?: number;
  zoom?: number;
  target?: number[];
  thresholds?: number[];
  level?: number;
  shown?: string[];
  opacity?: number;
  body?: string;
  clip?: { axis: string; beyond: string; at: number };
}

interface Window {
  affskel: object; // for tests
}
