// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// An avatar with its skin: the file is loaded once; its nodes follow the skeleton. For a
// VRM file, three-vrm draws the materials and moves hair and clothes.

import {
  Group, Matrix4, MeshBasicMaterial, MeshLambertMaterial, Quaternion, SkinnedMesh, TextureLoader,
} from 'three';
import type {Material, Mesh, MeshStandardMaterial, Object3D} from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import type {GLTF, GLTFParser} from 'three/addons/loaders/GLTFLoader.js';
import {VRMLoaderPlugin, VRMLookAtLoaderPlugin, VRMUtils} from '@pixiv/three-vrm';
import type {VRM} from '@pixiv/three-vrm';
import type {Skin} from './body_view';
import {PosedSkeleton} from './posed_skeleton';
import type {Pose} from './posed_skeleton';
import type {SkeletonWords, SkinWords} from '../protocol/protocol';
import {NodeDriver} from './skin_fit';

const LONGEST_STEP_S = 0.1;

/** Poses turn the eyes; a gaze of the file would be reported as unsupported in the console. */
class NoGaze extends VRMLookAtLoaderPlugin {
  override async afterRoot(): Promise<void> {}
}

export class AvatarView implements Skin {
  readonly object = new Group();
  private readonly nodes: (Object3D | null)[];
  private readonly driver: NodeDriver;
  private readonly local = new Float32Array(4);
  private readonly root: Object3D;
  /** Transform from the world to the frame of the root node's parent. */
  private readonly parent_from_world: Matrix4;
  private readonly vrm: VRM | undefined;
  private last_ms = 0;

  private constructor(private readonly file: GLTF, words: SkeletonWords, skin: SkinWords,
    plain: boolean) {
    this.vrm = file.userData.vrm as VRM | undefined;
    this.object.add(file.scene);
    this.nodes = nodesOf(file, skin.node_index);
    const [root] = this.nodes;
    if (!root) throw new Error('its root joint is not a node of the file');
    this.root = root;
    this.stand(skin);
    this.driver = this.fit(new PosedSkeleton(words));
    this.parent_from_world = root.parent!.matrixWorld.clone().invert();
    this.object.position.set(...words.offset_m);
    if (!this.vrm || plain) file.scene.traverse(lighten);
  }

  /** Fetches the skin of a skeleton. Throws an Error with the cause. `plain`: without costly
   *  materials. Precondition: the skeleton has a skin. */
  static async load(words: SkeletonWords, signal: AbortSignal, plain: boolean):
    Promise<AvatarView> {
    const skin = words.skin!;
    const answer = await fetch(skin.media, {signal, credentials: 'same-origin'});
    if (!answer.ok) throw new Error(`${skin.media}: ${answer.status} ${answer.statusText}`);
    const loader = new GLTFLoader();
    // Load pictures with <img>: the default loader fetches blob: URLs, which the policy forbids.
    loader.register((parser: GLTFParser) => {
      parser.textureLoader = new TextureLoader(parser.options.manager);
      return {name: 'MAREY_pictures'};
    });
    if (skin.format === 'vrm') {
      loader.register((parser) => new VRMLoaderPlugin(parser,
        {autoUpdateHumanBones: false, lookAtPlugin: new NoGaze(parser)}));
    }
    const file = await loader.parseAsync(await answer.arrayBuffer(), '');
    signal.throwIfAborted();
    return new AvatarView(file, words, skin, plain);
  }

  /** Applies the pose. */
  update(pose: Pose): void {
    const {nodes, local, root} = this;
    for (let i = 0; i < nodes.length; ++i) {
      const node = nodes[i];
      if (!node) continue;
      this.driver.local(i, pose.world_from_joint, local);
      node.quaternion.set(local[0], local[1], local[2], local[3]);
    }
    const p = pose.p_in_world;
    root.position.set(p[0], p[1], p[2]).applyMatrix4(this.parent_from_world);
    const now_ms = performance.now();
    this.vrm?.update(Math.min((now_ms - this.last_ms) / 1000, LONGEST_STEP_S));
    this.last_ms = now_ms;
  }

  dispose(): void {
    this.object.removeFromParent();
    VRMUtils.deepDispose(this.file.scene);
  }

  /** Scales and rotates the file, so that its rest pose matches the skeleton's. */
  private stand(skin: SkinWords): void {
    this.object.quaternion.set(...(skin.scene_from_file ?? [0, 0, 0, 1]));
    this.object.scale.setScalar(1 / skin.unit_from_m);
    this.object.updateMatrixWorld(true);
  }

  /** Computes the fit. Precondition: the pose and the file are at rest. */
  private fit(pose: Pose): NodeDriver {
    const {nodes} = this;
    const count = nodes.length;
    const node_rest = new Float32Array(4 * count);
    const parent_rest = new Float32Array(4 * count);
    const turned = new Quaternion();
    nodes.forEach((node, i) => {
      node?.getWorldQuaternion(turned).toArray(node_rest, 4 * i);
      node?.parent?.getWorldQuaternion(turned).toArray(parent_rest, 4 * i);
    });
    const places = new Map(nodes.map((node, i) => [node, i]));
    const ancestors = Int16Array.from(nodes, (node) => {
      for (let above = node?.parent; above; above = above.parent) {
        const place = places.get(above);
        if (place !== undefined) return place;
      }
      return -1;
    });
    return new NodeDriver(pose.world_from_joint, node_rest, parent_rest, ancestors);
  }
}

/** Returns the file's nodes by index; null for a node that is not in the scene. */
function nodesOf(file: GLTF, indices: number[]): (Object3D | null)[] {
  const byIndex = new Map<number, Object3D>();
  file.scene.traverse((node) => {
    const index = file.parser.associations.get(node)?.nodes;
    if (index !== undefined && !byIndex.has(index)) byIndex.set(index, node);
  });
  return indices.map((index) => byIndex.get(index) ?? null);
}

/** Removes costly details of little effect: specular shine, unused morph targets. */
function lighten(node: Object3D): void {
  const mesh = node as Mesh;
  if (!mesh.isMesh) return;
  if ((mesh as SkinnedMesh).isSkinnedMesh) mesh.frustumCulled = false;
  mesh.geometry.morphAttributes = {};
  mesh.morphTargetInfluences = undefined;
  mesh.material = Array.isArray(mesh.material)
    ? mesh.material.map(plainer) : plainer(mesh.material);
}

function plainer(material: Material): Material {
  if (material instanceof MeshBasicMaterial) return material;
  const old = material as MeshStandardMaterial;
  const made = new MeshLambertMaterial({
    name: old.name, color: old.color, map: old.map, side: old.side, opacity: old.opacity,
    transparent: old.transparent, alphaTest: old.alphaTest, depthWrite: old.depthWrite,
    vertexColors: old.vertexColors, emissive: old.emissive, emissiveMap: old.emissiveMap,
  });
  material.dispose();
  return made;
}
