"""face_model.py: the face that live runs and their bench move, and what is in a model."""
import os
import shutil
import subprocess


def names_in(bin, model, key):
    return subprocess.run([bin + "/sinew-info", "--get", key, model], stdout=subprocess.PIPE, text=True, check=True).stdout.split()


def make_face(bin, root, folder, side):
    """The path of a model: of FACE, if that is set; else of the real face where its data are, or of the samples' head; side: of its voxels, mm."""
    if os.environ.get("FACE"):
        return os.environ["FACE"]
    shared = os.environ.get("SINEW_SHARED", os.path.join(root, "..", "shared"))
    face, obj, made = os.path.join(shared, "data", "face", "face_zyg.obj"), os.path.join(folder, "face.obj"), os.path.join(folder, "face.sinew")
    if os.path.exists(face):
        shutil.copy(face, obj)
    else:
        with open(obj, "wb") as to:
            subprocess.run(["awk", "-f", "samples/shape.awk", "-f", "samples/head.awk"], cwd=root, stdout=to, check=True)
    subprocess.run("%s/voxelise -q --unit mm -s %s %s | %s/attach -q -o %s" % (bin, side, obj, bin, made), shell=True, check=True)
    return made
