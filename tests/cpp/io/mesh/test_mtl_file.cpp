// MTL files, statement by statement. The truth is the format's own description (Alias|Wavefront, File Formats 4.2,
// section 5) and, for statements that begin with P, the extension of 2015 for physically based rendering.

#include <string>

#include "io/mesh/mtl_file.hpp"
#include "io/scene/mtl_picture.hpp"
#include "scene_files.hpp"

using namespace scene_files;
using io::FileTexture;
using io::MtlMaterial;
using io::MtlPicture;

namespace {

struct Mtl {
    Folder folder;
    io::FileScene scene;

    /// The first material of a file that begins with "newmtl m".
    MtlMaterial material(const std::string& statements) {
        scene = {};
        Checkpoint checkpoint;
        io::read_mtl(scene, folder.write("a.mtl", "newmtl m\n" + statements), checkpoint);
        REQUIRE_FALSE(scene.materials.empty());
        return std::get<MtlMaterial>(scene.materials[0].content);
    }
    std::string error(const std::string& statements) {
        try {
            material(statements);
        } catch (const SceneFileError& error) {
            CHECK(std::string(error.what()).starts_with(folder.path("a.mtl: line ")));
            return error.what();
        }
        return "no error";
    }
    bool warned(const std::string& part) const {
        for (const std::string& warning : scene.warnings)
            if (has(warning, part)) return true;
        return false;
    }
    std::string picture(const FileTexture& texture) const {
        return texture ? scene.pictures[static_cast<std::size_t>(texture.picture)].name : "none";
    }
};

MtlPicture picture_of(const std::string& text) {
    const auto parsed = io::parse_mtl_picture(text);
    REQUIRE(parsed);
    return *parsed;
}

}  // namespace

TEST_CASE("MTL: every statement that is read") {
    Mtl mtl;
    const MtlMaterial m = mtl.material(
        "Ka .1 .2 .3\nKd .2 .3 .4\nKs .3 .4 .5\nKe 4 5 6\nTf .5 .6 .7\nNs 96.5\nNi 1.45\nd 0.75\nillum 7\n"
        "Pr 0.25\nPm 0.5\nPc 0.125\nPcr 0.0625\n"
        "map_Kd kd.png\nmap_Ks ks.png\nmap_Ke ke.png\nmap_d d.png\nmap_Ns ns.png\nmap_Pr pr.png\nmap_Pm pm.png\n"
        "map_Bump -bm 0.3 bump.png\nnorm norm.png\nsharpness 60\nmap_aat on\nmap_Ka ka.png\n");
    check_vec(m.Ka, .1, .2, .3);
    check_vec(m.Kd, .2, .3, .4);
    check_vec(m.Ks, .3, .4, .5);
    check_vec(m.Ke, 4, 5, 6);
    check_vec(m.Tf, .5, .6, .7);
    CHECK(m.Ns == 96.5f);
    CHECK(m.Ni == 1.45f);
    CHECK(m.d == 0.75f);
    CHECK(m.illum == 7);
    CHECK(m.Pr == 0.25f);
    CHECK(m.Pm == 0.5f);
    CHECK(m.Pc == 0.125f);
    CHECK(m.Pcr == 0.0625f);
    CHECK(m.bm == 0.3f);
    CHECK(mtl.picture(m.map_Kd) == "kd.png");
    CHECK(mtl.picture(m.map_Ks) == "ks.png");
    CHECK(mtl.picture(m.map_Ke) == "ke.png");
    CHECK(mtl.picture(m.map_d) == "d.png");
    CHECK(mtl.picture(m.map_Ns) == "ns.png");
    CHECK(mtl.picture(m.map_Pr) == "pr.png");
    CHECK(mtl.picture(m.map_Pm) == "pm.png");
    CHECK(mtl.picture(m.bump) == "bump.png");
    CHECK(mtl.picture(m.norm) == "norm.png");
    CHECK(mtl.scene.warnings.empty());
    for (const std::string keyword : {"bump", "map_bump"}) {
        const MtlMaterial other = mtl.material(keyword + " -bm -2 b.png\n");
        CHECK(mtl.picture(other.bump) == "b.png");
        CHECK(other.bm == -2.0f);  // the format allows negative ones
    }
}

TEST_CASE("MTL: what a material does not say") {
    Mtl mtl;
    const MtlMaterial m = mtl.material("");
    CHECK(m.d == 1.0f);  // "a factor of 1.0 is fully opaque. This is the default"
    CHECK_FALSE(m.Ni);
    CHECK_FALSE(m.Pr);
    CHECK_FALSE(m.Pm);
    check_vec(m.Tf, 1, 1, 1);
    CHECK(m.bm == 1.0f);
    CHECK_FALSE(m.map_Kd);
    CHECK_FALSE(m.bump);
}

TEST_CASE("MTL: the illumination model is what it says, or follows from Ks") {
    Mtl mtl;
    for (int model = 0; model <= 10; ++model) {
        const std::string line = "illum " + std::to_string(model) + "\n";
        CHECK(mtl.material(line).illum == model);
        CHECK(mtl.material("Ks 1 1 1\n" + line).illum == model);
        CHECK(mtl.material(line + "Ks 1 1 1\n").illum == model);
        CHECK(mtl.scene.warnings.empty());
    }
    CHECK(mtl.material("Kd 1 1 1\n").illum == 1);
    CHECK(mtl.material("Ks .5 .5 .5\n").illum == 2);
    CHECK(mtl.material("Ks .5 .5 .5\nnewmtl other\n").illum == 2);  // and not the one after it
    for (const char* wrong : {"illum 11", "illum -1", "illum 2.5", "illum nan", "illum inf", "illum two", "illum"}) {
        CHECK(mtl.material(std::string(wrong) + "\n").illum == 1);
        CHECK(mtl.warned("a.mtl: line 2 cannot be read"));
    }
}

TEST_CASE("MTL: Tr near 1 without d is the opacity of the whole file, and a warning tells of it") {
    Mtl mtl;
    CHECK(mtl.material("Tr 1\nillum 2\n").d == 1.0f);
    CHECK(mtl.warned("read as an opacity"));
    CHECK(mtl.material("Tr 0.996078\nnewmtl glass\nTr 0.25\nnewmtl wall\nTr 0\nnewmtl leaf\nTr 0.25\nd 0.5\n").d ==
          0.996078f);
    CHECK(std::get<MtlMaterial>(mtl.scene.materials[1].content).d == 0.25f);
    CHECK(std::get<MtlMaterial>(mtl.scene.materials[2].content).d == 1.0f);
    CHECK(std::get<MtlMaterial>(mtl.scene.materials[3].content).d == 0.5f);
    CHECK(mtl.material("Tr 1\nd 0.75\n").d == 0.75f);
    CHECK(mtl.scene.warnings.empty());
}

TEST_CASE("MTL: a black Kd beside its texture is white, and a warning tells of it") {
    Mtl mtl;
    check_vec(mtl.material("Kd 0 0 0\nmap_Kd a.png\n").Kd, 1, 1, 1);
    CHECK(mtl.warned("the texture's colours are used"));
    check_vec(mtl.material("map_Kd a.png\nKd 0 0 0.5\nnewmtl black\nKd 0 0 0\n").Kd, 0, 0, 0.5);
    check_vec(std::get<MtlMaterial>(mtl.scene.materials[1].content).Kd, 0, 0, 0);
    CHECK(mtl.scene.warnings.empty());
}

TEST_CASE("MTL: keywords do not depend on case, and unknown ones are named once") {
    Mtl mtl;
    const MtlMaterial m = mtl.material("kd 0.5 0.25 0.125\nMAP_KD a.png\nmap_D b.png\nNS 8\nnewMTL b\ntr 0.25\n");
    check_vec(m.Kd, 0.5, 0.25, 0.125);
    CHECK(mtl.picture(m.map_Kd) == "a.png");
    CHECK(mtl.picture(m.map_d) == "b.png");
    CHECK(m.Ns == 8);
    CHECK(std::get<MtlMaterial>(mtl.scene.materials[1].content).d == 0.75f);
    CHECK(mtl.scene.warnings.empty());
    mtl.material("shine 3\nshine 4\nmap_Kd2 a.png\n");
    REQUIRE(mtl.scene.warnings.size() == 1);
    CHECK(mtl.warned("\"map_Kd2\", \"shine\" are unknown statements"));
}

TEST_CASE("MTL: Tr alone is one less d, and d wins where both are given") {
    Mtl mtl;
    CHECK(mtl.material("Tr 0.25\n").d == 0.75f);
    CHECK(mtl.material("d 0.5\nTr 0.25\n").d == 0.5f);
    CHECK(mtl.material("Tr 0.25\nd 0.5\n").d == 0.5f);
    CHECK(mtl.material("Tr 1\nd 1\n").d == 1.0f);
    CHECK(mtl.scene.warnings.empty());
    CHECK(mtl.material("d -halo 0.5\n").d == 0.5f);
    CHECK(mtl.warned("d -halo is not modelled"));

    // Values do not carry over to the next material.
    Checkpoint checkpoint;
    io::FileScene scene;
    io::read_mtl(scene, mtl.folder.write("two.mtl", "newmtl a\nd 0.5\nillum 4\nnewmtl b\nTr 0.25\nKs 1 1 1\n"),
                 checkpoint);
    CHECK(std::get<MtlMaterial>(scene.materials[1].content).d == 0.75f);
    CHECK(std::get<MtlMaterial>(scene.materials[1].content).illum == 2);
}

TEST_CASE("MTL: options of a picture have their own number of words") {
    const auto check_uv = [](const MtlPicture& picture, double u, double v) {
        const Vec2f uv = picture.transform(0.5f, 0.25f);
        CHECK(double(uv.x) == doctest::Approx(u).epsilon(1e-6));
        CHECK(double(uv.y) == doctest::Approx(v).epsilon(1e-6));
    };
    const MtlPicture all = picture_of(
        "-blendu off -blendv off -boost 2 -cc on -clamp on -imfchan r -mm 0.1 0.9 -o 0.1 0.2 0.3 -s 2 4 8 -t 1 2 3 "
        "-texres 512 -type sphere -bm 0.5 my wood.png");
    CHECK(all.name == "my wood.png");
    CHECK(all.bm == 0.5);
    check_uv(all, 2 * 0.5 + 0.1, 4 * 0.25 + 0.2);
    CHECK(all.clamps);
    CHECK(all.other_options == std::vector<std::string_view>{"-blendu", "-blendv", "-boost", "-cc", "-imfchan", "-mm",
                                                             "-t", "-texres", "-type"});
    CHECK_FALSE(picture_of("-clamp off wood.png").clamps);
    CHECK(picture_of("-clamp maybe wood.png").other_options == std::vector<std::string_view>{"-clamp"});
    // Their second and third words may be absent.
    check_uv(picture_of("-s 2 wood.png"), 1, 0.25);
    check_uv(picture_of("-o 2 wood.png"), 2.5, 0.25);
    check_uv(picture_of("-s 2 3 -o 1 -t 1 -mm 1 wood.png"), 2, 0.75);
    // Options with their default value are not reported.
    CHECK(picture_of("-blendu on -blendv on -cc off -clamp off wood.png").other_options.empty());
    // Names may look like options and numbers.
    CHECK(picture_of("-wood.png").name == "-wood.png");
    CHECK(picture_of("-s 1 1 1 2.png").name == "2.png");
    CHECK(picture_of("-clamp on 3").name == "3");
    for (const char* wrong : {"", "-s", "-s x y.png", "-s 1 1 1", "-o wood.png", "-bm wood.png", "-clamp on", "-mm 0"})
        CHECK_FALSE(io::parse_mtl_picture(wrong));
}

TEST_CASE("MTL: what is skipped or not modelled is named once") {
    Mtl mtl;
    mtl.material(
        "map_Kd -blendu off -clamp on -s 2 2 a.png\nmap_Ks -imfchan r a.png\nmap_d -bm 2 a.png\nmap_Ke -clamp off "
        "a.png\n");
    CHECK(mtl.scene.warnings.size() == 1);
    CHECK(mtl.warned("a.mtl: 3 options of pictures are skipped (-blendu, -bm, -imfchan)"));
    CHECK(mtl.scene.pictures.size() == 1);

    mtl.material("refl -type sphere sky.png\nrefl -type sphere sky.png\ndisp d.png\nPs 0.5\n");
    CHECK(mtl.scene.warnings.size() == 1);
    CHECK(mtl.warned("a.mtl: Ps, disp, refl are not modelled"));
    mtl.material("decal d.png\nPs 0\naniso 0.0\nanisor 0.5\n");
    CHECK(mtl.warned("a.mtl: decal is not modelled"));
    mtl.material("Ps 0\naniso 0.0\n");  // as Blender writes them for all materials
    CHECK(mtl.scene.warnings.empty());
}

TEST_CASE("MTL: numbers that no material can have") {
    Mtl mtl;
    for (const std::string key : {"Ka", "Kd", "Ks", "Ke", "Tf", "Ns", "Ni", "d", "Tr", "Pr", "Pm", "Pc", "Pcr"})
        for (const char* value : {"nan", "inf", "-inf", "-1", "1e300", "1e9999"})
            CHECK(has(mtl.error(key + ' ' + value + "\n"), "line 2: " + key + " must be finite and not negative"));
    for (const char* option : {"-s nan", "-s 1 inf", "-o 1e300", "-o 0 -1e39", "-bm nan", "-bm 1e300"})
        CHECK(has(mtl.error("bump " + std::string(option) + " a.png\n"),
                  "line 2: bump: the numbers of -s, -o and -bm must be finite"));

    const MtlMaterial m = mtl.material("d 7\nPr 2\nPm 1.5\nPc 9\nPcr 1e38\nNi 1000\n");
    CHECK(m.d == 1.0f);
    CHECK(m.Pr == 1.0f);
    CHECK(m.Pm == 1.0f);
    CHECK(m.Pc == 1.0f);
    CHECK(m.Pcr == 1.0f);
    CHECK(m.Ni == 10.0f);
    CHECK(mtl.scene.warnings.size() == 1);
    CHECK(mtl.warned(
        "a.mtl: line 2 has a number out of its range, as have 5 others; the nearest number in the range is used"));
    CHECK(mtl.material("Ni 0\n").Ni == 0.001f);
    CHECK(mtl.material("Tr 3\n").d == 0.0f);
    mtl.material("Kd spectral wood.rfl\nKs xyz 1 1 1\nPr\nKd 1 2\n");
    CHECK(mtl.warned("a.mtl: line 2 cannot be read, nor 3 others; they are left out"));
}

TEST_CASE("OBJ: each material's colour moves by its own -s and -o, also at vertices that two of them share") {
    const Folder folder;
    for (const char* name : {"a.png", "b.png"}) folder.write(name, "not decoded here");
    folder.write("a.mtl",
                 "newmtl a\nmap_Kd -s 2 3 a.png\nnewmtl b\nmap_Kd -o 0.25 0.5 b.png\nnewmtl c\nmap_Kd a.png\n");
    const std::string corners = "f 1/1 2/2 3/3\n";
    const Scene scene = read(
        folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\n" + corners +
                                  "usemtl b\n" + corners + "usemtl c\n" + corners + "usemtl a\n" + corners));
    REQUIRE(scene.triangles.size() == 4);
    const double truth[4][3][2] = {{{0, 0}, {2, 0}, {0, 3}},
                                   {{0.25, 0.5}, {1.25, 0.5}, {0.25, 1.5}},
                                   {{0, 0}, {1, 0}, {0, 1}},
                                   {{0, 0}, {2, 0}, {0, 3}}};
    for (std::size_t t = 0; t < 4; ++t)
        for (int i = 0; i < 3; ++i) {
            const Vec2f at = scene.uvs[scene.triangles[t].vertices[i]];
            const TextureReference& texture = scene.materials[scene.triangles[t].material].diffuse_texture;
            const Vec2f uv = {dot(texture.to_u, Vec3f{at.x, at.y, 1}), dot(texture.to_v, Vec3f{at.x, at.y, 1})};
            CHECK(double(uv.x) == doctest::Approx(truth[t][i][0]).epsilon(1e-6));
            CHECK(double(uv.y) == doctest::Approx(truth[t][i][1]).epsilon(1e-6));
        }
}
