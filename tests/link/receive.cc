// A program that receives what sinew igtl-out serves, by libopenigtlink, for tests/link/out.t, which builds it.
//
//     receive HOST PORT FILE    connects, asks for what is served, and receives until the connection ends
//
// A line for each message: its type, its device, and what the library makes of its content; "wrong", where the library
// finds its checksum or content wrong. Pixels of the last image are written to FILE.
#include <igtlCapabilityMessage.h>
#include <igtlClientSocket.h>
#include <igtlImageMessage.h>
#include <igtlPolyDataMessage.h>
#include <igtlSensorMessage.h>
#include <igtlStatusMessage.h>
#include <igtlStringMessage.h>
#include <igtlTransformMessage.h>
#include <igtlUnit.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace
{

// The header is taken into a message of its class, and the body received. Null: the content is wrong.
template <class M> typename M::Pointer take(igtl::ClientSocket *s, igtl::MessageHeader *header)
{
    auto m = M::New();
    m->SetMessageHeader(header);
    m->AllocatePack();
    s->Receive(m->GetPackBodyPointer(), (int)m->GetPackBodySize());
    if (m->Unpack(1) & igtl::MessageHeader::UNPACK_BODY) // 1: with its checksum
        return m;
    printf(" wrong\n");
    return nullptr;
}

void put_matrix(const igtl::Matrix4x4 &m)
{
    for (int c = 0; c < 4; c++)
        printf(" %.5g %.5g %.5g", m[0][c], m[1][c], m[2][c]);
}

void image(igtl::ClientSocket *s, igtl::MessageHeader *header, const char *path)
{
    auto m = take<igtl::ImageMessage>(s, header);
    int size[3], part[3], begin[3];
    float spacing[3];
    igtl::Matrix4x4 matrix;
    if (m.IsNull())
        return;
    m->GetDimensions(size);
    m->GetSubVolume(part, begin);
    m->GetSpacing(spacing);
    m->GetMatrix(matrix);
    printf(" %d %d %d components %d type %d system %d spacing %.5g %.5g matrix", size[0], size[1], size[2],
           m->GetNumComponents(), m->GetScalarType(), m->GetCoordinateSystem(), spacing[0], spacing[1]);
    put_matrix(matrix);
    printf("\n");
    FILE *to = fopen(path, "wb");
    if (!to || fwrite(m->GetScalarPointer(), 1, (size_t)m->GetSubVolumeImageSize(), to) == 0 || fclose(to))
        exit(1);
}

void transform(igtl::ClientSocket *s, igtl::MessageHeader *header)
{
    auto m = take<igtl::TransformMessage>(s, header);
    igtl::Matrix4x4 matrix;
    if (m.IsNull())
        return;
    m->GetMatrix(matrix);
    put_matrix(matrix);
    printf("\n");
}

void polydata(igtl::ClientSocket *s, igtl::MessageHeader *header)
{
    auto m = take<igtl::PolyDataMessage>(s, header);
    if (m.IsNull())
        return;
    auto points = m->GetPoints();
    auto polygons = m->GetPolygons();
    printf(" points");
    for (int i = 0; i < points->GetNumberOfPoints(); i++) {
        igtlFloat32 x, y, z;
        points->GetPoint((unsigned)i, x, y, z);
        printf(" %.4f %.4f %.4f", x, y, z);
    }
    printf(" polygons");
    for (unsigned i = 0; i < polygons->GetNumberOfCells(); i++)
        printf(" %u", polygons->GetCellSize(i));
    printf("\n");
}

void sensor(igtl::ClientSocket *s, igtl::MessageHeader *header)
{
    auto m = take<igtl::SensorMessage>(s, header);
    auto newton = igtl::Unit::New();
    if (m.IsNull())
        return;
    newton->Append(igtl::Unit::SI_DERIVED_NEWTON, 1);
    printf(" %u %s", m->GetLength(), m->GetUnit() == newton->Pack() ? "N" : "other");
    for (unsigned i = 0; i < m->GetLength(); i++)
        printf(" %.6g", m->GetValue(i));
    printf("\n");
}

void status(igtl::ClientSocket *s, igtl::MessageHeader *header)
{
    auto m = take<igtl::StatusMessage>(s, header);
    if (!m.IsNull())
        printf(" %d %s: %s\n", m->GetCode(), m->GetErrorName(), m->GetStatusString());
}

void text(igtl::ClientSocket *s, igtl::MessageHeader *header)
{
    auto m = take<igtl::StringMessage>(s, header);
    if (!m.IsNull())
        printf(" %s\n", m->GetString());
}

void capability(igtl::ClientSocket *s, igtl::MessageHeader *header)
{
    auto m = take<igtl::CapabilityMessage>(s, header);
    for (int i = 0; !m.IsNull() && i < m->GetNumberOfTypes(); i++)
        printf(" %s", m->GetType(i));
    printf("\n");
}

template <class M> void ask(igtl::ClientSocket *s, const char *device)
{
    auto m = M::New();
    m->SetDeviceName(device);
    m->Pack();
    s->Send(m->GetPackPointer(), (int)m->GetPackSize());
}

void receive(igtl::ClientSocket *s, const char *path)
{
    auto header = igtl::MessageHeader::New();
    for (;;) {
        header->InitPack();
        if (s->Receive(header->GetPackPointer(), (int)header->GetPackSize()) != header->GetPackSize())
            return;
        header->Unpack();
        const std::string type = header->GetDeviceType();
        printf("%s %s", type.c_str(), header->GetDeviceName());
        if (type == "IMAGE")
            image(s, header, path);
        else if (type == "TRANSFORM")
            transform(s, header);
        else if (type == "POLYDATA")
            polydata(s, header);
        else if (type == "SENSOR")
            sensor(s, header);
        else if (type == "STATUS")
            status(s, header);
        else if (type == "STRING")
            text(s, header);
        else if (type == "CAPABILITY")
            capability(s, header);
        else {
            printf("\n");
            s->Skip((int)header->GetBodySizeToRead(), 0);
        }
        fflush(stdout);
    }
}

} // namespace

int main(int argc, char **argv)
{
    auto s = igtl::ClientSocket::New();
    if (argc != 4 || s->ConnectToServer(argv[1], atoi(argv[2])))
        return 1;
    ask<igtl::GetCapabilityMessage>(s, "peer");
    ask<igtl::GetStatusMessage>(s, "");
    receive(s, argv[3]);
    return 0;
}
