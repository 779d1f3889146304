// The shapes of what the service answers, see client/web: messages of the contract as JSON.

// Texts by the words of the contract.
interface Words {
  states: Record<string, string>;
  stages: Record<string, string>;
  operators: Record<string, string>;
  frames: Record<string, string>;
  minima: Record<string, string>;
}
interface Session {
  mode: 'personal' | 'sign-in';
  signed_in: boolean;
  // Of the user that is signed in:
  owner?: any;
  admin?: boolean;
  max_mesh_bytes?: any;
  words?: any; // Words
  usual?: any; // words of operator, frame and minimum
  sheets?: any; // words of operators that give sheets and curves
  artefacts?: any;
  mesh_files?: any; // extensions of files, of which a page sends one for each mesh
  voxel_files?: any;
  packed_files?: any;
}

// What is seen at an address; one that asks is asked again and again, and given how.
interface View {
  element: HTMLElement;
  title: string;
  ask?(signal: AbortSignal): Promise<boolean>;
  refresh?(): any;
  pause?(): void;
}

interface Note {
  severity: string;
  message: string;
}
interface Job {
  id: string;
  name: string;
  owner: string;
  state: string;
  stage: string;
  priority: number;
  params: { sampling?: { spacing?: number; target_points?: number }; directions: string; frame: string | null; minimum?: string | null };
  skeleton: { operator: string | null; threshold?: number };
  prepared?: { triangles: number; points: number; spacing: number; volume: number; solids: number; notes?: Note[] };
  repair?: { steps: Note[] }; // of the mesh, before it was submitted
  quality?: { components: number };
  warnings?: { code: string; message: string }[]; // of a done job
  error?: { message: string; line: number };
  directions_done: number;
  directions_total: number;
  refine_round?: number;
  refined_points?: number; // of this round
  skeleton_points: number;
  waiting_reason?: string;
  cancel_requested: boolean;
  pinned: boolean;
  stance?: { up: string; front: string };
  created_ms: number;
  started_ms: number;
  finished_ms: number;
  remaining_ms?: number;
  expires_ms: number;
  removed_ms: number;
}
// What of a job's stage is done, in units named by `unit`.
interface Progress {
  done: number;
  total: number;
  unit: string;
  where: string;
}
interface Rate {
  perSecond: number;
}
/** How an upload is read, and what is made of it. */
interface Asked {
  repair?: 'auto' | 'fill' | 'wrap';
  isovalue?: string;
}
