//! Seeds for the fuzz targets that read model files: one for each kind of contents.

use microphong_stress::readers;

/// A target and a file.
type Seed = (&'static str, Vec<u8>);

const STL: [&str; 3] = [
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n",
    "SOLID\nfacet\nvertex 0 0 0 vertex 1 0 0 vertex 0 1 .5e0\nend facet\nend solid\n# text\nsolid b\ncolor 1 0 0\nfacet normal nan 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n",
    "solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1,5 0 0 vertex 0 1 0 endloop endfacet endsolid rest",
];

const PLY_VERTICES: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n";
const PLY_FACES: &str = "element face 1\nproperty list uchar int vertex_indices\n";

const PLY: [&str; 3] = [
    "ply\nformat ascii 1.0\ncomment a\nelement vertex 4\nproperty float x\nproperty float y\nproperty double z\nelement face 2\nproperty list uchar int vertex_index\nproperty uchar red\nend_header\n0 0 0\n1 0 0\n0 1 0\nnan 0 0\n3 0 1 2 255\n2 0 1 0\n",
    "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nelement tristrips 1\r\nproperty list int int vertex_indices\r\nelement edge 0\r\nproperty int a\r\nend_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n1 1 0\r\n6 0 1 2 -1 1 2 \r\n",
    "PLY\nformat ascii 1.0\nobj_info a\nelement a 2\nelement vertex 3\nproperty int x\nproperty int y\nproperty int z\nproperty ushort red\nproperty ushort green\nproperty ushort blue\nproperty uchar alpha\nelement face 1\nproperty list uchar uint vertex_indices\nend_header\n\n\n0 0 0 1 2 3 4\n1 0 0 1 2 3 4\n0 1 0 1 2 3 4\n3 0 1 2\n",
];

const MTL: [&str; 3] = [
    "mtllib a.mtl\no one\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a # b\ns 1\nf 1/1 2/2 3/3\ns off\nusemtl c\nf 3 2 1\n\0newmtl a\nKd 1 0.5 0\nKs 0.5\nNs 30\nmap_Kd -s 1 1 1 a.png\nnewmtl c\nKa spectral a\nKe 1 1 1\nd 0.5\nillum 1\n",
    "mtllib \"a.mtl\" none.mtl\ng x\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv .5 .2 0\nv 0 1 0\nvn 0 0 1\nusemtl A\nf 1//1 2//1 3//1 4//1 5//1\nf 1 2\nvp 1\nl 1 2\nwrong\n\0newmtl a\nTr 0.5\nbump b.png\nmap_Kd a.png\nKd 0 0 0\n",
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nvn 1.#QNAN 0 0\nv 1e200 0 0\n",
];

/// Texts of glTF, each with its binary chunk in hexadecimal digits.
const GLTF: [[&str; 2]; 5] = [
    [
        r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"a","translation":[1,0,0],"scale":[-1,2,1]}],"buffers":[{"byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"metallicFactor":0,"roughnessFactor":0.5}}]}"#,
        "00000000000000000000000000803f0000000000000000000000000000803f00000000",
    ],
    [
        r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"skin":0,"children":[1]},{"rotation":[0,0.6,0,0.8]}],"skins":[{"joints":[1]}],"buffers":[{"byteLength":96}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":60}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":3,"type":"VEC4"},{"bufferView":1,"byteOffset":12,"componentType":5126,"count":3,"type":"VEC4"},{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":0}}}],"meshes":[{"weights":[0.5],"primitives":[{"mode":5,"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2},"targets":[{"POSITION":3}]}]}]}"#,
        "00000000000000000000000000803f0000000000000000000000000000803f00000000000000000000000000000000000000000000803f0000000000000000000000000000803f0000000000000000000000000000803f000000000000000000000000",
    ],
    [
        r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"extensionsUsed":["KHR_texture_transform"],"buffers":[{"byteLength":60,"uri":"a.bin"}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},{"bufferView":0,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}],"images":[{"uri":"a.png"}],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[0.5,0],"rotation":1}}}},"extensions":{"KHR_materials_pbrSpecularGlossiness":{"glossinessFactor":0.5}}}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,"COLOR_0":2},"material":0}]}]}"#,
        "00000000000000000000000000803f0000000000000000000000000000803f00000000000000000000000000000000000000000000803f0000000000000000",
    ],
    [
        r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}]}],"accessors":[{"componentType":5123,"type":"SCALAR","count":36},{"componentType":5126,"type":"VEC3","count":8}],"bufferViews":[{"buffer":0,"byteLength":80}],"buffers":[{"byteLength":80}],"extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"]}"#,
        "445241434f02020101000000080c000b0000035f4b1501011001ff000001000903000002010101000303012001200300b0429c2002050800000000ff3f00000000000000000000000000000000803f0e",
    ],
    [
        r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],"accessors":[{"componentType":5123,"type":"SCALAR","count":36,"bufferView":0},{"componentType":5122,"type":"VEC3","count":8,"bufferView":1,"normalized":true}],"bufferViews":[{"buffer":1,"byteLength":72,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":0,"byteLength":29,"mode":"TRIANGLES","byteStride":2,"count":36}}},{"buffer":1,"byteOffset":72,"byteLength":64,"byteStride":8,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":32,"byteLength":73,"mode":"ATTRIBUTES","byteStride":8,"count":8}}}],"buffers":[{"byteLength":105},{"byteLength":136,"extensions":{"EXT_meshopt_compression":{"fallback":true}}}],"extensionsUsed":["EXT_meshopt_compression","KHR_mesh_quantization"],"extensionsRequired":["EXT_meshopt_compression","KHR_mesh_quantization"]}"#,
        "e1f02030110015201620170503007687566778a9866589689801690000000000a0020034343000000000010664000001303000000304011020000001030300000304010102000000000000000000000000000000000000000000000000000000000000180018001800000000000",
    ],
];

const THREEMF: [&str; 3] = [
    r#"<?xml version="1.0"?><model unit="millimeter"><resources><object id="1"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object><object id="2" name="a"><components><component objectid="1" transform="1 0 0 0 1 0 0 0 -1 4 0 0"/></components></object></resources><build><item objectid="2"/><item objectid="1"/></build></model>"#,
    r##"<model requiredextensions="m b" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"><resources><basematerials id="3"><base name="r&amp;d" displaycolor="#FF000080"/></basematerials><m:colorgroup id="4"><m:color color="#00FF00"/><m:color color="#0000FF"/></m:colorgroup><m:texture2d id="5" path="/3D/a.png"/><m:texture2dgroup id="6" texid="5"><m:tex2coord u="0" v="1"/></m:texture2dgroup><object id="1" pid="3" pindex="0"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1e0" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/><triangle v1="0" v2="1" v3="2" pid="4" p1="0" p2="1" p3="1"/><triangle v1="0" v2="1" v3="2" pid="6" p1="0"/></triangles></mesh></object></resources><build><item objectid="1"/></build></model>"##,
    "<model><resources><object id='1'><components><component objectid='1' p:path='/3D/a.model'/></components></object></resources><build><item objectid='1'/></build></model>\0<model><resources><object id='1' type='solidsupport'><mesh/></object><object id='2'/></resources></model>",
];

fn bytes_of(hex: &str) -> Vec<u8> {
    hex.as_bytes().chunks_exact(2).filter_map(|pair| u8::from_str_radix(str::from_utf8(pair).ok()?, 16).ok()).collect()
}

fn binary_stl() -> Vec<u8> {
    let floats = [0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes);
    [&[b' '; 80][..], &1u32.to_le_bytes(), floats.as_flattened(), &[0; 2]].concat()
}

fn binary_ply(format: &str, number: fn(f32) -> [u8; 4], index: fn(i32) -> [u8; 4]) -> Vec<u8> {
    let mut bytes = format!("ply\nformat {format} 1.0\n{PLY_VERTICES}{PLY_FACES}end_header\n").into_bytes();
    for corner in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
        bytes.extend([corner[0], corner[1], 0.0, 0.0, 0.0, 1.0].map(number).as_flattened());
        bytes.extend([255, 128, 0]);
    }
    bytes.push(4);
    bytes.extend([0, 1, 2, 3].map(index).as_flattened());
    bytes
}

/// All seeds.
pub(crate) fn seeds() -> Vec<Seed> {
    let texts = |target, texts: &[&str]| texts.iter().map(|text| (target, text.as_bytes().to_vec())).collect::<Vec<Seed>>();
    let mut seeds = [texts("stl", &STL), texts("ply", &PLY), texts("mtl", &MTL), texts("threemf", &THREEMF)].concat();
    seeds.push(("stl", binary_stl()));
    seeds.push(("ply", binary_ply("binary_little_endian", f32::to_le_bytes, i32::to_le_bytes)));
    seeds.push(("ply", binary_ply("binary_big_endian", f32::to_be_bytes, i32::to_be_bytes)));
    seeds.push(("image", readers::IMAGE.to_vec()));
    for [text, binary] in GLTF {
        seeds.push(("gltf", [text.as_bytes(), &[0], &bytes_of(binary)].concat()));
    }
    let [text, binary] = GLTF[0];
    seeds.push(("gltf", readers::glb(text.as_bytes(), &bytes_of(binary))));
    seeds.extend(THREEMF.map(|text| ("archive", readers::of_models(text.as_bytes()))));
    seeds
}
