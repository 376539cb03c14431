// A program that sends poses by Debian's libopenigtlink, for tests/link/in.t, which builds it.
//
//     send listen WORD...        waits at a free port, which it prints, for one who connects
//     send HOST PORT WORD...     connects
//     send pack WORD...          writes the messages to standard output
//
// A word is a message (see `words`), or `asked`: waits for STT_TDATA, prints what it says, and answers; `left`: waits
// for STP_TDATA, or for the end of the connection. The k-th message, from 0, is sent at 1000 + k / 4 s by its stamp,
// and its pose is a quarter of a turn about z, at (10 k, 20, 30) mm.
#include <igtlClientSocket.h>
#include <igtlImageMessage.h>
#include <igtlPointMessage.h>
#include <igtlPositionMessage.h>
#include <igtlSensorMessage.h>
#include <igtlServerSocket.h>
#include <igtlStatusMessage.h>
#include <igtlStringMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

namespace
{

void pose_of(int k, igtl::Matrix4x4 &m)
{
    igtl::IdentityMatrix(m);
    m[0][0] = m[1][1] = 0;
    m[0][1] = -1;
    m[1][0] = 1;
    m[0][3] = 10.f * (float)k;
    m[1][3] = 20;
    m[2][3] = 30;
}

igtl::MessageBase::Pointer transform(int k)
{
    auto m = igtl::TransformMessage::New();
    igtl::Matrix4x4 pose;
    pose_of(k, pose);
    m->SetMatrix(pose);
    return m.GetPointer();
}

igtl::MessageBase::Pointer lost(int)
{
    auto m = igtl::TransformMessage::New();
    igtl::Matrix4x4 pose;
    memset(pose, 0, sizeof pose);
    m->SetMatrix(pose);
    return m.GetPointer();
}

igtl::MessageBase::Pointer position_as(int k, int type)
{
    auto m = igtl::PositionMessage::New();
    const float half = .70710678f;
    m->SetPackType(type);
    m->SetPosition(10.f * (float)k, 20, 30);
    m->SetQuaternion(0, 0, half, half);
    return m.GetPointer();
}

igtl::MessageBase::Pointer position(int k)
{
    return position_as(k, igtl::PositionMessage::ALL);
}

igtl::MessageBase::Pointer position3(int k)
{
    return position_as(k, igtl::PositionMessage::WITH_QUATERNION3);
}

igtl::MessageBase::Pointer place(int k)
{
    return position_as(k, igtl::PositionMessage::POSITION_ONLY);
}

igtl::MessageBase::Pointer tools(int k)
{
    auto m = igtl::TrackingDataMessage::New();
    for (int i = 0; i < 2; i++) {
        auto tool = igtl::TrackingDataElement::New();
        igtl::Matrix4x4 pose;
        pose_of(k + 100 * i, pose);
        tool->SetName(i ? "Stylus" : "Probe");
        tool->SetType(igtl::TrackingDataElement::TYPE_6D);
        tool->SetMatrix(pose);
        m->AddTrackingDataElement(tool);
    }
    return m.GetPointer();
}

igtl::MessageBase::Pointer status(int)
{
    auto m = igtl::StatusMessage::New();
    m->SetCode(igtl::StatusMessage::STATUS_NOT_READY);
    m->SetSubCode(7);
    m->SetErrorName("Warming");
    m->SetStatusString("the cameras warm up");
    return m.GetPointer();
}

igtl::MessageBase::Pointer text(int)
{
    auto m = igtl::StringMessage::New();
    m->SetString("hello from the library");
    return m.GetPointer();
}

igtl::MessageBase::Pointer image(int)
{
    auto m = igtl::ImageMessage::New();
    m->SetDimensions(320, 240, 1);
    m->SetScalarType(igtl::ImageMessage::TYPE_UINT8);
    m->AllocateScalars();
    memset(m->GetScalarPointer(), 7, (size_t)m->GetImageSize());
    return m.GetPointer();
}

igtl::MessageBase::Pointer point(int)
{
    auto m = igtl::PointMessage::New();
    auto p = igtl::PointElement::New();
    p->SetName("a");
    p->SetPosition(1, 2, 3);
    m->AddPointElement(p);
    return m.GetPointer();
}

igtl::MessageBase::Pointer sensor(int)
{
    auto m = igtl::SensorMessage::New();
    m->SetLength(2);
    m->SetValue(0, 1.5);
    m->SetValue(1, 2.5);
    return m.GetPointer();
}

const std::map<std::string, igtl::MessageBase::Pointer (*)(int)> words = {
    {"transform", transform}, {"lost", lost},   {"position", position}, {"position3", position3},
    {"place", place},         {"tools", tools}, {"status", status},     {"string", text},
    {"image", image},         {"point", point}, {"sensor", sensor}};

// The header of the next message, whose body is left out of it; null at the end.
igtl::MessageHeader::Pointer receive_header(igtl::Socket *s)
{
    auto header = igtl::MessageHeader::New();
    header->InitPack();
    if (s->Receive(header->GetPackPointer(), (int)header->GetPackSize()) != header->GetPackSize())
        return nullptr;
    header->Unpack();
    return header;
}

int receive_start(igtl::Socket *s)
{
    auto header = receive_header(s);
    if (!header || strcmp(header->GetDeviceType(), "STT_TDATA") != 0)
        return -1;
    auto m = igtl::StartTrackingDataMessage::New();
    m->SetMessageHeader(header);
    m->AllocatePack();
    s->Receive(m->GetPackBodyPointer(), (int)m->GetPackBodySize());
    if (!(m->Unpack(1) & igtl::MessageHeader::UNPACK_BODY)) // 1: with its checksum
        return -1;
    printf("STT_TDATA %d '%s'\n", (int)m->GetResolution(), m->GetCoordinateName());
    fflush(stdout);
    auto answer = igtl::RTSTrackingDataMessage::New();
    answer->SetStatus(igtl::RTSTrackingDataMessage::STATUS_SUCCESS);
    answer->Pack();
    return s->Send(answer->GetPackPointer(), (int)answer->GetPackSize()) ? 0 : -1;
}

int receive_end(igtl::Socket *s)
{
    auto header = receive_header(s);
    printf("%s\n", header ? header->GetDeviceType() : "closed");
    fflush(stdout);
    return 0;
}

int send(igtl::Socket *s, const std::string &word, int k)
{
    const auto found = words.find(word);
    if (found == words.end()) {
        fprintf(stderr, "send: '%s'; expected a message\n", word.c_str());
        return -1;
    }
    auto m = found->second(k);
    auto time = igtl::TimeStamp::New();
    time->SetTime(1000 + .25 * k);
    m->SetDeviceName(word == "tools" ? "Tracker" : "ProbeToReference");
    m->SetTimeStamp(time);
    m->Pack();
    if (!s)
        return fwrite(m->GetPackPointer(), (size_t)m->GetPackSize(), 1, stdout) == 1 ? 0 : -1;
    return s->Send(m->GetPackPointer(), (int)m->GetPackSize()) ? 0 : -1;
}

int send_all(igtl::Socket *s, char **word)
{
    for (int k = 0; *word; word++) {
        int failed;
        if (!strcmp(*word, "asked"))
            failed = receive_start(s);
        else if (!strcmp(*word, "left"))
            failed = receive_end(s);
        else
            failed = send(s, *word, k++);
        if (failed) {
            fprintf(stderr, "send: '%s' failed\n", *word);
            return 1;
        }
    }
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    const std::string how = argc > 1 ? argv[1] : "";
    if (how == "pack")
        return send_all(nullptr, argv + 2);
    if (how == "listen") {
        auto server = igtl::ServerSocket::New();
        if (server->CreateServer(0) < 0)
            return 1;
        printf("port %d\n", server->GetServerPort());
        fflush(stdout);
        auto peer = server->WaitForConnection(20000);
        if (peer.IsNull())
            return 1;
        const int status = send_all(peer, argv + 2);
        peer->CloseSocket();
        return status;
    }
    if (argc < 3)
        return 2;
    auto peer = igtl::ClientSocket::New();
    if (peer->ConnectToServer(argv[1], atoi(argv[2])) != 0)
        return 1;
    const int status = send_all(peer, argv + 3);
    peer->CloseSocket();
    return status;
}
